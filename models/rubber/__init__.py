"""Laws of rubber: what each adds to the linear spring and dashpot, one file a law.

    s = m (k u_e + sum of what the laws add) + c u',   u_e = u - u_p,

u the compression (m), s the stress per metre of contact (N m-1), m the product of what softens, u_p what shifts;
the total is clipped at zero under dashpot law B. Over an open fibre u = 0 and its history goes on.
"""

from __future__ import annotations

from models.rubber import bouc_wen, hardening, locking, maxwell, mullins, permanent_set
from models.rubber.base import RubberLaw, further

LAWS: dict[str, RubberLaw] = {
    module.LAW.name: module.LAW for module in (hardening, locking, maxwell, bouc_wen, mullins, permanent_set)
}
"""The laws that differ from the linear one."""
ELEMENTS: dict[str, RubberLaw] = {
    **LAWS,
    **{again.name: again for again in (further(LAWS[name], ("isolated",)) for name in ("maxwell", "bouc_wen"))},
}
"""The same with a second element of those that are sums in the literature: arms that relax, hysteretic elements."""
