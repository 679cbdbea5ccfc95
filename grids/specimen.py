"""Specimen files: one wall as the laboratory knows it.

title = "wall 3"
model = "housner"
[parameters]                      # nominal; numbers are SI
width = "0.25 m"
[tolerance]                       # one sigma: relative, or with the unit of the value ("2 mm")
width = 0.005
[measured]                        # what a tolerance is about where [parameters] holds another, fitted value
width = "0.252 m"
[calibrate]                       # unknown, with a range
restitution = [0.7, 1.0]
[motion]
vertical = false
[initial]                         # state at t = 0, at rest without it
rotation_1 = "2 deg"
[options]
formulation = "linear"
[instruments]
reference_peak = "2 deg"          # that levels of instruments are given over; the run's own without it
[mechanisms.pivot_inset]
inset_over_half_width = 0.1
[channels.lvdt_left]              # instruments on the bodies, to be simulated or thought of (see
quantity = "displacement"         # `grids.recordings.placed`)
[[mechanisms.pivot_inset.stages]] # when it acts (see `grids.stages`); always without stages
recording = "shake_2"
begins = 4.21
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pydantic import Field

from grids.consistency import check_joints, check_laws, check_names
from grids.files import Schema, check, parse_toml, path_of, read_text
from grids.instruments import INSTRUMENTS
from grids.law_table import read_law
from grids.plan_checks import check_cells, check_vertical
from grids.recordings.base import CHANNELS
from grids.recordings.placed import read_places
from grids.stages import Stage, StageTable, read_stages
from grids.targets import Targets, find_model
from grids.units import to_si, with_unit
from models.base import Mechanism
from models.errors import InputError, nearest
from models.kinematics import Place
from models.model import Model
from models.tables import Tables

MOST_TOLERANCE = 1.0
STAGES = "stages"
UNITS_OF_STATES = {"rotation_rate": "rad s-1", "rotation": "rad", "velocity": "m s-1", "displacement": "m"}
"""By how the name of a state begins that a model does not observe."""


class MotionTable(Schema):
    vertical: bool | None = None


class InstrumentsTable(Schema):
    reference_peak: float | str | None = None


class SpecimenFile(Schema):
    title: str
    model: str
    parameters: dict[str, Any]
    tolerance: dict[str, float | str] = Field(default_factory=dict)
    measured: dict[str, float | str] = Field(default_factory=dict)
    calibrate: dict[str, Any] = Field(default_factory=dict)
    motion: MotionTable = MotionTable()
    initial: dict[str, float | str] = Field(default_factory=dict)
    instruments: InstrumentsTable = InstrumentsTable()
    options: dict[str, str] = Field(default_factory=dict)
    mechanisms: dict[str, dict[str, Any]] = Field(default_factory=dict)
    channels: dict[str, dict[str, Any]] = Field(default_factory=dict)


@dataclass(frozen=True)
class Specimen:
    """A checked specimen in SI. ``calibrate`` holds (low, high); ``vertical`` None: the model decides.

    ``tolerance``: one sigma, relative to what was `nominal`: ``measured``, of parameters that a fit has moved.

    ``stages``: when a mechanism acts, by its name; without an entry always.
    ``places``: instruments on the bodies that `simulate` writes and that a next experiment may ask for.
    ``reference_peak``: rotation (rad) that levels of instruments are given over; None: the largest of a run itself.
    """

    title: str
    model: str
    parameters: Mapping[str, float]
    tolerance: Mapping[str, float] = field(default_factory=dict)
    measured: Mapping[str, float] = field(default_factory=dict)
    calibrate: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    vertical: bool | None = None
    initial: Mapping[str, float] = field(default_factory=dict)
    options: Mapping[str, str] = field(default_factory=dict)
    mechanisms: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    reference_peak: float | None = None
    stages: Mapping[str, tuple[Stage, ...]] = field(default_factory=dict)
    places: Mapping[str, Place] = field(default_factory=dict)

    @property
    def nominal(self) -> dict[str, float]:
        """The parameters as the laboratory has measured them."""
        return {**self.parameters, **self.measured}


def read_specimen(path: str | Path) -> Specimen:
    """Read and check a specimen file, with the mechanisms of the wall and of its instruments.

    Raises InputError with one sentence: file, key, value, cure.
    """
    path = path_of(path, "specimen")
    text = read_text(path, "specimen")
    try:
        return parse_specimen(text, path.resolve().parent)
    except InputError as error:
        raise InputError(f"{path.name}: {error}") from None


def parse_specimen(text: str, folder: Path = Path()) -> Specimen:
    """The specimen of a TOML text, whose files lie in ``folder``. Raises InputError."""
    file = check(SpecimenFile, parse_toml(text))
    model = find_model(file.model, "model")
    targets = Targets(model, with_instruments=True)
    parameters = {}
    for name, value in file.parameters.items():
        where = f"[parameters] {name}"
        target = targets.find(name, where)
        if target.words or "." in name:
            table = "[options]" if target.words else "[mechanisms]"
            raise InputError(f"{where}: this does not belong to [parameters]; put it in {table}.")
        parameters[name] = target.number(value, where)
    mechanisms = _mechanisms(file, targets, folder)
    calibrate = {name: _range(name, entry, targets) for name, entry in targets.flatten(file.calibrate).items()}
    known = {*parameters, *(f"{m}.{p}" for m, values in mechanisms.items() for p in values)}
    if twice := sorted(known & calibrate.keys()):
        raise InputError(f"[calibrate] {twice[0]} has a fixed value too; leave that out, or the range.")
    used = {n.split(".")[0]: targets.mechanism(n.split(".")[0], n) for n in known | {*calibrate} if "." in n}
    check_names(model, known | calibrate.keys(), used)
    options = {name: targets.option(name, word, f"[options] {name}") for name, word in file.options.items()}
    check_laws(options, (), used)
    check_joints(model, options, (), known | calibrate.keys())
    check_vertical(model, file.motion.vertical)
    measured = _measured(file, targets)
    fixed = {**parameters, **{f"{m}.{p}": v for m, values in mechanisms.items() for p, v in values.items()}}
    if not calibrate:
        of_wall = {n: v for n, v in fixed.items() if n.partition(".")[0] not in INSTRUMENTS}
        check_cells(model, of_wall, (), options)
    return Specimen(
        title=file.title,
        model=model.name,
        parameters=parameters,
        tolerance=_tolerance(file, {**parameters, **measured}, targets),
        measured=measured,
        calibrate=calibrate,
        vertical=file.motion.vertical,
        initial=_initial(file, targets),
        options=options,
        mechanisms=mechanisms,
        reference_peak=_reference_peak(file.instruments),
        stages=_stages(file),
        places=read_places(file.channels, CHANNELS),
    )


def with_mechanism(specimen: Specimen, name: str, values: Mapping[str, float]) -> Specimen:
    """The specimen with a mechanism or instrument at ``values``, in the place of its own. Raises InputError."""
    targets = Targets(find_model(specimen.model, "model"), with_instruments=True)
    checked = {p: targets.find(f"{name}.{p}", f"{name}.{p}").number(v, f"{name}.{p}") for p, v in values.items()}
    return replace(specimen, mechanisms={**specimen.mechanisms, name: checked})


def _reference_peak(table: InstrumentsTable) -> float | None:
    if table.reference_peak is None:
        return None
    peak = to_si(table.reference_peak, "rad", "[instruments] reference_peak")
    if not 0.0 < peak < math.inf:
        raise InputError(f"[instruments] reference_peak = {peak:g} rad: give a rotation above 0, or leave it out.")
    return peak


def _mechanisms(file: SpecimenFile, targets: Targets, folder: Path) -> dict[str, dict[str, float]]:
    mechanisms: dict[str, dict[str, float]] = {}
    for name, table in file.mechanisms.items():
        mechanism = targets.mechanism(name, f"[mechanisms.{name}]")
        values = {parameter: value for parameter, value in table.items() if parameter != STAGES}
        if not values:
            raise InputError(f"[mechanisms.{name}] is empty; give its parameters or leave the table out.")
        if mechanism.tabulated is not None:
            mechanisms[name] = _law(mechanism, mechanism.tabulated, values, folder, targets)
            continue
        mechanisms[name] = {}
        for parameter, value in values.items():
            where = f"[mechanisms.{name}] {parameter}"
            mechanisms[name][parameter] = targets.find(f"{name}.{parameter}", where).number(value, where)
    return mechanisms


def _stages(file: SpecimenFile) -> dict[str, tuple[Stage, ...]]:
    found = {}
    for name, table in file.mechanisms.items():
        entries = table.get(STAGES, [])
        if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
            raise InputError(f"[mechanisms.{name}] {STAGES} = {entries!r}: write [[mechanisms.{name}.stages]] tables.")
        if stages := read_stages(name, [_stage(name, number, entry) for number, entry in enumerate(entries, 1)]):
            found[name] = stages
    return found


def _stage(name: str, number: int, entry: dict[str, Any]) -> StageTable:
    try:
        return check(StageTable, entry)
    except InputError as error:
        raise InputError(f"[[mechanisms.{name}.{STAGES}]] {number}: {error}") from None


def _law(
    mechanism: Mechanism, tables: Tables, table: Mapping[str, Any], folder: Path, targets: Targets
) -> dict[str, float]:
    """The values of a law in a table, from its file, and of the oscillator beside it."""
    name = mechanism.name
    beside = {key: value for key, value in table.items() if key in tables.oscillator}
    if not isinstance(table.get("file"), str) or table.keys() - beside.keys() != {"file"}:
        more = f" and, for an oscillator, {', '.join(tables.oscillator)}" if tables.oscillator else ""
        raise InputError(f'[mechanisms.{name}] has {", ".join(table)}: give file = "law.csv"{more}, and nothing else.')
    found = {key: mechanism.nulls[key] for key in tables.oscillator} | read_law(folder / table["file"], tables)
    for key, value in beside.items():
        where = f"[mechanisms.{name}] {key}"
        found[key] = targets.find(f"{name}.{key}", where).number(value, where)
    return found


def _tolerance(file: SpecimenFile, parameters: Mapping[str, float], targets: Targets) -> dict[str, float]:
    tolerance = {}
    for name, value in file.tolerance.items():
        where = f"[tolerance] {name}"
        if name not in parameters:
            raise InputError(f"{where} has no value in [parameters]; {nearest(name, parameters)}")
        if parameters[name] == 0.0:
            raise InputError(f"{where}: the value is 0, which has no relative tolerance; leave it out.")
        tolerance[name] = _relative(value, parameters[name], targets.find(name, where).unit, where)
        if not 0.0 < tolerance[name] < MOST_TOLERANCE:
            raise InputError(
                f"{where} = {tolerance[name]:g}: a tolerance is relative, above 0 and below 1 "
                "(0.01 for 1 %); leave it out for an exact value."
            )
    return tolerance


def _measured(file: SpecimenFile, targets: Targets) -> dict[str, float]:
    measured = {}
    for name, value in file.measured.items():
        where = f"[measured] {name}"
        for table, known in (("parameters", file.parameters), ("tolerance", file.tolerance)):
            if name not in known:
                raise InputError(f"{where} is not in [{table}]; add it there, or leave it out here.")
        measured[name] = targets.find(name, where).number(value, where)
    return measured


def _relative(value: float | str, nominal: float, unit: str, where: str) -> float:
    """A tolerance over the nominal value: numbers and per cent are that already, a text may have the value's unit."""
    try:
        return to_si(value, "1", where)
    except InputError:
        if unit == "1" or not isinstance(value, str):
            raise
    return to_si(value, unit, where) / abs(nominal)


def _range(name: str, entry: object, targets: Targets) -> tuple[float, float]:
    where = f"[calibrate] {name}"
    target = targets.find(name, where)
    if target.words:
        raise InputError(f"{where}: an option cannot be calibrated; put it in [options].")
    if target.whole:
        raise InputError(f"{where}: a whole number cannot be calibrated; give it a value in [mechanisms].")
    if not isinstance(entry, list) or len(entry) != 2:
        raise InputError(f"{where} = {entry!r}: give the range [low, high].")
    low, high = (target.number(end, where) for end in entry)
    if not low < high:
        ends = f"[{with_unit(low, target.unit)}, {with_unit(high, target.unit)}]"
        raise InputError(f"{where} = {ends}: low must be below high; swap or part them.")
    return low, high


def _initial(file: SpecimenFile, targets: Targets) -> dict[str, float]:
    initial = {}
    for name, value in file.initial.items():
        where = f"[initial] {name}"
        initial[name] = to_si(value, state_unit(targets.model, name, where), where)
        if abs(initial[name]) == float("inf"):
            raise InputError(f"{where} = {initial[name]}: give a finite value.")
    return initial


def state_unit(model: Model, name: str, where: str) -> str:
    """The SI unit of a state of ``model``; InputError with the nearest one where it has no such state."""
    if name not in model.states:
        raise InputError(f"{where} is no state of model '{model.name}'; {nearest(name, model.states)}")
    units = {quantity.name: quantity.unit for quantity in model.observables}
    return units.get(name) or next(unit for start, unit in UNITS_OF_STATES.items() if name.startswith(start))


def with_values(specimen: Specimen, values: Mapping[str, float]) -> Specimen:
    """The specimen with these values of parameters, and of mechanisms by ``mechanism.parameter``.

    Tolerances stay those of what was measured.
    """
    moved = {name: specimen.nominal[name] for name in specimen.tolerance if name in values}
    parameters = dict(specimen.parameters)
    mechanisms = {name: dict(own) for name, own in specimen.mechanisms.items()}
    for name, value in values.items():
        mechanism, dot, parameter = name.partition(".")
        if dot:
            mechanisms.setdefault(mechanism, {})[parameter] = value
        else:
            parameters[name] = value
    measured = {**specimen.measured, **moved}
    return replace(specimen, parameters=parameters, mechanisms=mechanisms, measured=measured)
