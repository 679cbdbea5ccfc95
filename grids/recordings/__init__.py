"""Recordings of shake-table tests: readers, checks, suspicions, noise."""

from __future__ import annotations

from grids.recordings.base import CHANNELS, Recording
from grids.recordings.noise import Noise, noise_levels, noise_of
from grids.recordings.read import read_recording

__all__ = ["CHANNELS", "Noise", "Recording", "noise_levels", "noise_of", "read_recording"]
