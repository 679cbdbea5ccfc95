"""``diagnosis.json`` as the design fixes it: these keys, these types, no others."""

from __future__ import annotations

from typing import Any, Literal

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


class EffectPart(Part):
    name: str
    effect_class: str = Field(alias="class")
    parameters: dict[str, ParameterPart]
    evidence: float
    p_value: float = Field(ge=0.0, le=1.0)


class RivalPart(Part):
    name: str
    effect_class: str = Field(alias="class")
    evidence_gap: float


class LocatedPart(Part):
    recording: str
    channel: str
    start: float
    end: float
    where: list[Where]
    share: float = Field(ge=0.0, le=1.0)


class ConstancyPart(Part):
    parameter: str
    depends_on: str
    evidence: float


class TrainPart(Part):
    before: float
    after: float


class HoldoutPart(TrainPart):
    share_of_achievable: float | None


class FitPart(Part):
    train: TrainPart
    holdout: HoldoutPart | None


class AnswerFile(Part):
    verdict: Literal["missing", "nothing_missing", "not_in_library", "cannot_tell_apart"]
    effects: list[EffectPart]
    rivals: list[RivalPart]
    located: list[LocatedPart]
    constancy: list[ConstancyPart]
    fit: FitPart
    statement: str = Field(min_length=1)
    next_experiment: dict[str, Any] | None
    provenance: dict[str, Any]
