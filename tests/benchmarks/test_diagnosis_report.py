"""Figures of the bench by group, and the weights of the weak form."""

from __future__ import annotations

import json

import numpy as np
import pytest

from benchmarks.diagnosis import report
from benchmarks.diagnosis.weak_form import weights
from diagnosis.prove.scores import Scored
from tests.diagnosis.prove.answered import CASES, FIRST, key, said


def test_groups_carry_their_suffix_and_models() -> None:
    half = [Scored("20", said("missing", [FIRST]), key("single", FIRST, noise=0.03, size=0.5))]
    figures = report.grouped([*CASES, *half])
    assert figures["cases"] == len(CASES)
    assert figures["half_size_3_percent"]["class_first_half"] == 1.0
    assert figures["by_model"]["housner"]["false_alarm"] == 0.5
    assert figures["nominal_size_half_percent"]["class_first"] is None
    assert figures["intervals"]["open_precision"]["of"] == 2 and figures["share_of_achievable"] is None
    assert "half size" in report.tables(figures)
    json.dumps(figures, allow_nan=False)


def test_weights_of_the_weak_form_integrate_by_parts() -> None:
    step, time = 1e-3, 1e-3 * np.arange(201)
    test, curve = weights(201, step)
    theta = np.sin(9.0 * time)
    assert step * curve @ theta == pytest.approx(step * test @ (-81.0 * theta), rel=1e-4)


def test_tables_of_a_bench_without_groups_are_one_table() -> None:
    shown = report.tables(report.of_all(CASES))
    assert shown.startswith("1 % noise, nominal size") and len(shown.split(" cases {")) == 2
