"""``diagnosis.json`` as the design fixes it: these keys, these types, and what was added to it since; no others."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

Where = Literal[
    "impact", "between_impacts", "first_uplift", "large_rotation", "small_rotation", "left", "right", "late",
    "above_10_hz", "everywhere",
]  # fmt: skip


class Part(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class ParameterPart(Part):
    estimate: float
    low95: float
    high95: float | None
    unit: str
    at_bound: Literal["low", "high"] | None


class StagePart(Part):
    recording: str
    begins: float = Field(ge=0.0)
    ends: float | None
    begins_low95: float | None
    begins_high95: float | None
    ends_low95: float | None
    ends_high95: float | None


class EffectPart(Part):
    name: str
    effect_class: str = Field(alias="class")
    parameters: dict[str, ParameterPart]
    evidence: float
    p_value: float = Field(ge=1e-6, le=1.0)
    stages: list[StagePart]


class RivalPart(Part):
    name: str
    effect_class: str = Field(alias="class")
    evidence_gap: float
    in_place_of: str


class ShowsPart(Part):
    recording: str
    channel: str
    start: float
    end: float
    where: list[Where]
    share: float = Field(ge=0.0, le=1.0 + 1e-9)


class LocatedPart(ShowsPart):
    effect: str | None
    amplitude: float | None
    unit: str | None


class ConstancyPart(Part):
    parameter: str
    depends_on: str
    stronger: str | None
    evidence: float


class UndecidedPart(Part):
    name: str
    effect_class: str = Field(alias="class")
    gain: float
    rests_on: Literal["one window", "one recording", "the recordings fitted to"] | None


class SuspicionPart(Part):
    recording: str
    suspicion: str


class BeyondPart(Part):
    effect: str
    parameter: str
    limit: float
    wanted: float
    unit: str
    evidence: float


class UnfitPart(Part):
    recording: str
    start: float
    end: float
    misfit: float = Field(gt=0.0)


class TrainPart(Part):
    before: float
    after: float
    noise_floor: float


class HeldStagePart(Part):
    effect: str
    recording: str
    begins: float
    ends: float | None
    found_there: bool


class HoldoutPart(TrainPart):
    share_of_achievable: float | None
    stages: list[HeldStagePart]
    contradicted: tuple[float, float] | None


class FitPart(Part):
    train: TrainPart
    holdout: HoldoutPart | None


class NotTriedPart(Part):
    name: str
    why: str


class LinePart(Part):
    frequency: float
    amplitude: float


class SpectrumPart(Part):
    frequency: list[float]
    estimated: list[float]
    found: list[float]
    lag: list[float]
    correlation: list[float]
    bound: float


class ChannelErrorsPart(Part):
    channel: str
    unit: str
    noise: float = Field(ge=0.0)
    colour: Literal["white", "low", "filtered"]
    corner_hz: float | None
    drift: float = Field(ge=0.0)
    growing: float = Field(ge=0.0)
    hum: list[LinePart]
    spectrum: SpectrumPart


class ScatterPart(Part):
    events: str
    estimate: float = Field(ge=0.0)
    low95: float
    high95: float
    deviance: float
    at_limit: bool


class InadequacyPart(Part):
    size: list[float]
    ratio: float
    deviance: float
    judged: bool


class ErrorsPart(Part):
    channels: list[ChannelErrorsPart]
    scatter: ScatterPart | None
    base_noise: list[float]
    base_drift: float | None
    inadequacy: InadequacyPart
    still_seconds: float


class ScreenPart(Part):
    name: str
    effect_class: str = Field(alias="class")
    score: float
    gain: float | None
    estimate: dict[str, float | None] | None


class TablePart(Part):
    term: str
    meaning: str
    unit: str
    variable: str
    variable_unit: str
    at: list[float]
    value: list[float]
    low95: list[float]
    high95: list[float]
    evidence: float
    nearest: list[float | None] | None


class OscillatorPart(Part):
    estimate: float
    low95: float
    high95: float


class LawStagePart(Part):
    recording: str
    begins: float
    ends: float | None


class MissingForcePart(Part):
    terms: list[TablePart]
    nearest: str | None
    parameters: dict[str, float]
    stages: list[LawStagePart]
    oscillator: dict[Literal["motion", "force", "frequency", "damping"], OscillatorPart] | None


class OtherModelPart(Part):
    effect: str
    model: str
    options: dict[str, str]
    parameters: dict[str, float]
    evidence: float
    instead: list[str]
    inadequate: bool
    vertical: bool


class FurtherRecordingPart(Part):
    base_motion: str
    scale: float
    expected_evidence: float


class FurtherSensorPart(Part):
    channel: str
    noise: str
    expected_evidence: float


class NextExperimentPart(Part):
    separates: list[str]
    recording: FurtherRecordingPart | None
    sensor: FurtherSensorPart | None
    static_test: str | None


class NoisePart(Part):
    sigma: list[float]
    unit: str


class ProvenancePart(Part):
    specimen: str | None
    model: str
    model_version: str
    recordings: list[str]
    windows: int
    channels: list[str]
    noise: dict[str, NoisePart]
    misfit_per_sample: float
    gain_by_recording: dict[str, float]
    constancy_threshold: float
    largest_constancy: float
    largest_constancy_of: str | None
    seed: int
    commit: str | None
    made: str = Field(pattern=r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
    python: str
    rocking_study: str = Field(alias="rocking-study")
    numpy: str
    scipy: str
    numba: str
    xarray: str
    netcdf: str = Field(alias="netCDF4")
    dask: str
    distributed: str
    salib: str = Field(alias="SALib")
    seen: list[str]
    finished: bool
    skipped: list[str]
    failed: dict[str, str]


class AnswerFile(Part):
    verdict: Literal["missing", "nothing_missing", "not_in_library", "cannot_tell_apart"]
    effects: list[EffectPart]
    rivals: list[RivalPart]
    located: list[LocatedPart]
    shows: list[ShowsPart]
    constancy: list[ConstancyPart]
    detail: ConstancyPart | None
    undecided: UndecidedPart | None
    beyond_range: list[BeyondPart]
    unfit_windows: list[UnfitPart]
    suspicions: list[SuspicionPart]
    base: dict[str, ParameterPart]
    screen: list[ScreenPart]
    null_band: float
    missing_force: MissingForcePart | None
    p_value: float | None = Field(ge=1e-6, le=1.0)
    reference_peak: float | None
    fit: FitPart
    statement: str = Field(min_length=1)
    next_experiment: NextExperimentPart | None
    other_model: OtherModelPart | None
    errors: ErrorsPart | None
    not_tried: list[NotTriedPart]
    channels: dict[str, dict[str, float | None]]
    provenance: ProvenancePart
