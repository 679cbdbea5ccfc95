"""Studies over specimens that may name instruments: `study.run.run` with their mechanisms known."""

from __future__ import annotations

from functools import partial, update_wrapper

from diagnosis.sensors import SENSORS
from study.run import run as run_study

run = update_wrapper(partial(run_study, sensors=SENSORS), run_study)
