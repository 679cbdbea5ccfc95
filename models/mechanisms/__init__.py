"""The catalogue of physics that a base model may leave out, one file a mechanism."""

from __future__ import annotations

from models.base import Mechanism
from models.mechanisms import pivot_inset, restitution

MECHANISMS: dict[str, Mechanism] = {
    module.MECHANISM.name: module.MECHANISM for module in (pivot_inset, restitution)
}
