# make study   set up everything and run the main job: walls on rubber layers, plan to maps
# make test    set up everything, then lint, types and tests
# make quick   the same without the slow tests
# make proofs  long cases of tests of which make test runs other cases
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/.ready
OLDEST := .venv-oldest
STUDY := results/rubber_interface
HEAVY := --select "top_mass=5 t" --select damping_ratio=0.0544

.PHONY: study quick test proofs lint types bench independent faults long fuzz verify processors audit test-oldest agreement diagnosis-bench laboratory-bench processed-bench beginnings-bench walls-bench stacks-bench bases-bench bench-refine bench-scale gallery docs clean

study: $(READY)
	$(BIN)/rocking run studies/rubber_interface.toml
	$(BIN)/rocking map $(STUDY) --y layer_modulus $(HEAVY)
	$(BIN)/rocking map $(STUDY) --x layer_modulus --y pga --select aspect_ratio=0.4 $(HEAVY) --out $(STUDY)/short_wall
	$(BIN)/rocking slices $(STUDY) uplift_duration --x layer_modulus --select "pga=0.315 g" $(HEAVY)

quick: $(READY) lint types
	$(BIN)/python -m pytest -n 2 --dist loadfile --no-loadscope-reorder -m "not slow and not proof"

# types beside the tests; kernels compiled at a lower level of optimisation, in half the time and kept apart from those
# of studies
test: $(READY) lint
	$(BIN)/mypy & types=$$!; \
	NUMBA_OPT=1 $(BIN)/python -m pytest -n 2 --dist loadfile --no-loadscope-reorder -m "not proof"; tests=$$?; \
	wait $$types || { echo "mypy found errors: see above"; exit 1; }; \
	exit $$tests

proofs: $(READY)
	$(BIN)/python -m pytest -n 2 --dist loadfile --no-loadscope-reorder -m proof

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(READY)
	$(BIN)/mypy

bench: $(READY)
	-$(BIN)/pip install --quiet -e ".[proof]"
	$(BIN)/python -m benchmarks.one_block
	$(BIN)/python -m benchmarks.two_blocks

independent: $(READY)
	-$(BIN)/pip install --quiet -e ".[proof]"
	$(BIN)/python -m benchmarks.independent

faults: $(READY)
	$(BIN)/python -m benchmarks.faults

long: $(READY)
	$(BIN)/python -m benchmarks.faults.long

fuzz: $(READY)
	$(BIN)/python -m benchmarks.fuzz

verify: $(READY)
	$(BIN)/rocking verify

processors: $(READY)
	$(BIN)/python -m benchmarks.processors

audit: $(READY)
	$(BIN)/python -m benchmarks.audit

# the lowest versions that pyproject.toml allows, in an environment of its own; SALib before 1.5.2 needs a pandas before 3
test-oldest:
	test -x $(OLDEST)/bin/python || $(PYTHON) -m venv $(OLDEST)
	$(PYTHON) -c "import tomllib; print(*(d.replace('>=', '==') for d in tomllib.load(open('pyproject.toml', 'rb'))['project']['dependencies']), 'pandas<3', sep='\n')" > $(OLDEST)/oldest.txt
	$(OLDEST)/bin/python -m pip install --quiet --disable-pip-version-check -c $(OLDEST)/oldest.txt -e . pytest hypothesis
	$(OLDEST)/bin/python -m pytest -q -m "not slow and not proof" -W ignore::DeprecationWarning -W "ignore:numpy.ndarray size changed" -W "ignore:unique with argument:FutureWarning" tests/grids tests/study

agreement: $(READY)
	$(BIN)/python -m benchmarks.agreement

diagnosis-bench: $(READY)
	$(BIN)/python -m benchmarks.diagnosis

laboratory-bench: $(READY)
	$(BIN)/python -m benchmarks.diagnosis laboratory

processed-bench: $(READY)
	$(BIN)/python -m benchmarks.diagnosis processed

beginnings-bench: $(READY)
	$(BIN)/python -m benchmarks.diagnosis beginnings

walls-bench: $(READY)
	$(BIN)/python -m benchmarks.diagnosis walls

stacks-bench: $(READY)
	$(BIN)/python -m benchmarks.diagnosis stacks

bases-bench: $(READY)
	$(BIN)/python -m benchmarks.diagnosis bases

bench-refine: $(READY)
	$(BIN)/python -m benchmarks.refinement

bench-scale: $(READY)
	$(BIN)/python -m benchmarks.scale

gallery: $(READY)
	$(BIN)/python docs/make_gallery.py

docs: $(READY)
	$(BIN)/pip install --quiet -e ".[docs]"
	$(BIN)/sphinx-build -W --keep-going -b html docs docs/_build/html

$(READY): pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[dev]"
	touch $@

clean:
	rm -rf .venv $(OLDEST) docs/_build .mypy_cache .ruff_cache .pytest_cache
