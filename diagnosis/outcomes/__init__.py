"""Diagnosis from outcomes alone: runs of which is known only whether the specimen overturned."""

from __future__ import annotations

from diagnosis.outcomes.answer import OutcomeDiagnosis, Prediction
from diagnosis.outcomes.chain import diagnose_outcomes
from diagnosis.outcomes.predict import predict_outcomes

__all__ = ["OutcomeDiagnosis", "Prediction", "diagnose_outcomes", "predict_outcomes"]
