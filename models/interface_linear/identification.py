"""What a diagnosis needs to know of walls on linear layers: as on other rubber, but nothing is carried yet."""

from __future__ import annotations

from dataclasses import replace

from models.interface import identification

IDENTIFICATION = replace(identification.IDENTIFICATION, carrying=False)
