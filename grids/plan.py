"""Plan files: what a study varies, by what the wall is shaken, what is kept.

[study]
name = "slender_walls"            # its folder under results/
model = "housner"                 # or: specimen = "extended.toml"
[motion]
files = ["ridgecrest_2019_clc"]   # several records make the axis `motion`, the first dimension
component = "north"
vertical = true
[parameters]                      # fixed values; numbers are SI
height = "1.8 m"
[options]                         # words of the model
formulation = "nonlinear"
[axes]                            # in the order of the cube's dimensions
pga = { linspace = [0.05, 0.77, 37], unit = "g" }
[samples]                         # what a diagnosis found, with its uncertainty: the axis `sample`, first of all
from = "answer/posterior.nc"
[outputs]
names = ["peak_rotation"]         # all without this table
[run]
block_seconds = 5
tail = "10 s"
integrator = "lanes"
[refine]                          # compute the borders of onset and overturning, infer the rest
budget = 0.1
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from pydantic import Field

from grids.alike import taken_once
from grids.axes import Axis, Request, read_axis
from grids.consistency import check_joints, check_laws, check_names, replaced
from grids.files import Schema, check, parse_toml, path_of, read_text
from grids.grid import Grid
from grids.instruments import INSTRUMENTS
from grids.motions import Motion
from grids.plan_checks import check_cells, check_refinable, check_scales, check_size
from grids.plan_motions import MotionTable, read_motions
from grids.samples import NAME as SAMPLE
from grids.samples import SamplesTable, read_samples
from grids.specimen import Specimen, read_specimen
from grids.stages import after_the_last
from grids.targets import Targets, find_model
from grids.units import to_si
from models.errors import InputError, nearest
from models.model import Model


class StudyTable(Schema):
    name: str
    model: str | None = None
    specimen: str | None = None


class OutputsTable(Schema):
    names: list[str] = Field(min_length=1)


class RunTable(Schema):
    block_seconds: float | str = 5.0
    tail: float | str = 10.0
    integrator: str | None = None


class RefineTable(Schema):
    """``budget``: largest share of cells to compute; ``guard``: cells of a guard sample and of the audit."""

    budget: float = Field(default=0.1, gt=0.0, le=1.0)
    guard: int = Field(default=1000, ge=1)
    seed: int = Field(default=1, ge=0)


class PlanFile(Schema):
    study: StudyTable
    motion: MotionTable = MotionTable()
    parameters: dict[str, Any] = Field(default_factory=dict)
    options: dict[str, str] = Field(default_factory=dict)
    axes: dict[str, Any] = Field(default_factory=dict)
    samples: SamplesTable | None = None
    outputs: OutputsTable | None = None
    run: RunTable = RunTable()
    refine: RefineTable | None = None


@dataclass(frozen=True, eq=False)
class Plan:
    """A checked plan. Numbers are SI; ``fixed`` holds "mechanism.parameter" keys too.

    An axis `motion` (or a case that sets `motion`) holds names of ``motions``; without one there is
    a single motion. ``notes`` say what a reader decided; ``given_in_run``: the keys that [run] states itself.
    """

    name: str
    model: str
    options: Mapping[str, str]
    fixed: Mapping[str, float]
    axes: tuple[Axis, ...]
    motions: tuple[Motion, ...]
    outputs: tuple[str, ...]
    integrator: str
    tail: float
    block_seconds: float
    text: str
    specimen: Specimen | None = None
    notes: tuple[str, ...] = field(default=())
    given_in_run: frozenset[str] = frozenset()
    refine: RefineTable | None = None

    @cached_property
    def grid(self) -> Grid:
        """The cells; records, time scales and formulations are kept in blocks apart."""
        import models

        model = models.get(self.model)
        return Grid(self.axes, frozenset(a.name for a in self.axes if any(taken_once(model, n) for n in a.sets)))


def read_plan(path: str | Path) -> Plan:
    """Read and check a plan file.

    A plan that names a mechanism of instruments is refused, a specimen's are left out, since a study shows
    the wall and not what was recorded of it. Paths in the plan are relative to its folder.
    Raises InputError with one sentence: file, key, value, cure.
    """
    path = path_of(path, "plan")
    text = read_text(path, "plan")
    try:
        return parse_plan(text, path.resolve().parent)
    except InputError as error:
        raise InputError(f"{path.name}: {error}") from None


def parse_plan(text: str, folder: Path) -> Plan:
    """The plan of a TOML text, whose relative paths start at ``folder``. Raises InputError."""
    file = check(PlanFile, parse_toml(text))
    if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", file.study.name):
        raise InputError(f"[study] name = '{file.study.name}' becomes a folder; use letters, digits, '_', '-' and '.'.")
    specimen = _specimen(file.study, folder)
    model = find_model(specimen.model if specimen else file.study.model, "[study] model")
    targets = Targets(model, with_scales=True)
    own = _fixed(file, targets)
    axes = _axes(file, targets, folder)
    varied = _varied(axes, own, file.options, SAMPLE if file.samples else None)
    base, notes = _from_specimen(specimen, [*own, *varied], targets)
    fixed = {**base, **own}
    if unknown := replaced(model, specimen.calibrate if specimen else {}, {*own, *varied}):
        raise InputError(
            f"[study] specimen leaves {next(iter(unknown))} to calibration; "
            "fix it in [parameters], vary it in [axes] or take [samples]."
        )
    named = {*fixed, *varied}
    used = {n.split(".")[0]: targets.mechanism(n.split(".")[0], n) for n in named if "." in n}
    check_names(model, named, used)
    options = dict(specimen.options) if specimen else {}
    options |= {name: targets.option(name, word, f"[options] {name}") for name, word in file.options.items()}
    options = {name: word for name, word in options.items() if name not in varied}
    check_laws(options, varied, used)
    check_joints(model, options, varied, {*own, *varied})  # the specimen's numbers suit its own options
    vertical = specimen.vertical if specimen else None
    motions, axes = read_motions(file.motion, axes, folder, model, vertical, "vertical_acceleration" in used)
    check_scales(named, motions)
    check_size(axes)
    check_cells(model, fixed, axes, options)
    if file.refine is not None:
        check_refinable(model, axes)
    return Plan(
        name=file.study.name,
        model=model.name,
        options=options,
        fixed=fixed,
        axes=axes,
        motions=motions,
        outputs=_outputs(file.outputs, model),
        integrator=_integrator(file.run, model),
        tail=_seconds(file.run.tail, "tail", zero=True),
        block_seconds=_seconds(file.run.block_seconds, "block_seconds", zero=False),
        text=text,
        specimen=specimen,
        notes=notes,
        given_in_run=frozenset(file.run.model_fields_set),
        refine=file.refine,
    )


def _specimen(table: StudyTable, folder: Path) -> Specimen | None:
    if (table.model is None) == (table.specimen is None):
        held = "both" if table.model else "neither"
        raise InputError(f"[study] has {held} of model and specimen; give exactly one.")
    return after_the_last(read_specimen(folder / table.specimen)) if table.specimen else None


def _fixed(file: PlanFile, targets: Targets) -> dict[str, float]:
    fixed = {}
    for name, value in targets.flatten(file.parameters).items():
        where = f"[parameters] {name}"
        target = targets.find(name, where)
        if target.words:
            raise InputError(f"{where}: this is an option of the model; put it in [options].")
        if isinstance(value, list | dict):
            raise InputError(f"{where} = {value!r}: one fixed value stands here; put what varies in [axes].")
        fixed[name] = target.number(value, where)
    return fixed


def _axes(file: PlanFile, targets: Targets, folder: Path) -> tuple[Axis, ...]:
    model = targets.model
    labelled = (*model.outputs, *model.derived)
    taken = frozenset({*targets.names(), *(quantity.name for quantity in labelled)})
    table = targets.flatten(file.axes)
    axes = tuple(read_axis(Request(name, entry, targets, folder, taken)) for name, entry in table.items())
    return axes if file.samples is None else (read_samples(file.samples, targets, folder), *axes)


def _varied(
    axes: tuple[Axis, ...], fixed: Mapping[str, float], options: Mapping[str, str], sampled: str | None
) -> set[str]:
    """Every name that varies; InputError where a name is set in two places."""
    places = {**dict.fromkeys(fixed, "[parameters]"), **dict.fromkeys(options, "[options]")}
    varied = set()
    if len({axis.name for axis in axes}) < len(axes):
        raise InputError(f"[samples] makes the axis '{SAMPLE}'; call that of [axes] something else.")
    for axis in axes:
        where = "[samples]" if axis.name == sampled else f"[axes] {axis.name}"
        for name in axis.sets:
            if name in places:
                raise InputError(f"'{name}' is set by {places[name]} and by {where}; leave one out.")
            places[name] = where
            varied.add(name)
    return varied


def _from_specimen(
    specimen: Specimen | None, overrides: list[str], targets: Targets
) -> tuple[dict[str, float], tuple[str, ...]]:
    """The specimen's values that the plan leaves standing, and notes on what a study leaves out."""
    if specimen is None:
        return {}, ()
    notes = []
    values = dict(specimen.parameters)
    for name, parameters in specimen.mechanisms.items():
        if name in INSTRUMENTS:
            notes.append(f"{name} of the specimen acts on its instruments; a study leaves it out")
            continue
        values |= {f"{name}.{parameter}": value for parameter, value in parameters.items()}
    if specimen.initial:
        notes.append("the specimen's [initial] state is left out: each cell starts at rest")
    return replaced(targets.model, values, overrides), tuple(notes)


def _outputs(table: OutputsTable | None, model: Model) -> tuple[str, ...]:
    known = [output.name for output in model.outputs]
    without_history = [output.name for output in model.outputs if not output.peak_of]
    names = without_history if table is None else table.names
    for index, name in enumerate(names):
        if name not in known:
            raise InputError(f"[outputs] names: '{name}' is no output of model '{model.name}'; {nearest(name, known)}")
        if name in names[:index]:
            raise InputError(f"[outputs] names: '{name}' is given twice; leave one out.")
    return tuple(names)


def _integrator(table: RunTable, model: Model) -> str:
    if table.integrator is None:
        return model.integrators[0]
    if table.integrator not in model.integrators:
        raise InputError(f"[run] integrator = '{table.integrator}'; {nearest(table.integrator, model.integrators)}")
    return table.integrator


def _seconds(value: float | str, key: str, zero: bool) -> float:
    seconds = to_si(value, "s", f"[run] {key}")
    if not (0.0 <= seconds < float("inf")) or (seconds == 0.0 and not zero):
        least = "zero or more" if zero else "above zero"
        raise InputError(f"[run] {key} = {seconds:g} s; give a finite time, {least}.")
    return seconds
