"""What a diagnosis needs to know of walls on linear layers: as on other rubber, with no history to carry."""

from __future__ import annotations

from dataclasses import replace

from models.interface import identification

IDENTIFICATION = replace(identification.IDENTIFICATION, not_carried=())
