"""What a diagnosis needs to know of walls on linear layers: as on other rubber, which has laws of its own there."""

from __future__ import annotations

from dataclasses import replace

from models.interface import identification

IDENTIFICATION = replace(identification.IDENTIFICATION, coordinates=(), whole={})
