"""Suite `well-clear`: the point verdicts of the well-clear volume with modified tau.

A case gives the relative state `s`, `v` (three numbers each, ownship minus intruder, metres and
metres per second), the thresholds `D`, `Z`, `TTHR`, `TCOA`, and the truth: `x_exact_h` and
`x_exact_v`, decided on the rationals that the doubles are. Compared are the exact readings of the
horizontal, the vertical and the combined kernel, and the combined one with the roles swapped.
"""

from __future__ import annotations

from typing import Any

from cratous.core.compiled import exact
from cratous.core.kernel import Vec2
from cratous.core.well_clear import horizontal_violation, vertical_violation, violation
from cratous.services.conform import Result, failed, not_covered, passed
from cratous.services.conform.values import identity, not_negative, truth, vector

DETECTOR = "WCV_TAUMOD"


def judge(case: dict[str, Any]) -> Result:
    """Compare one case."""
    name = identity(case)
    detector = case.get("det", DETECTOR)
    if detector != DETECTOR:
        return not_covered(name, f"detector {detector}")
    if "x_exact_h" not in case and "x_exact_v" not in case:
        return not_covered(name, "no exact verdict given")
    sx, sy, sz = vector(case, "s", 3)
    vx, vy, vz = vector(case, "v", 3)
    dthr, zthr, tthr, tcoa = (not_negative(case, n) for n in ("D", "Z", "TTHR", "TCOA"))
    horizontal, vertical = truth(case, "x_exact_h"), truth(case, "x_exact_v")
    s, v = Vec2(sx, sy), Vec2(vx, vy)
    back_s, back_v = Vec2(-sx, -sy), Vec2(-vx, -vy)
    both = horizontal and vertical
    rows = (
        ("horizontal", horizontal, exact(horizontal_violation, s, v, dthr, tthr)),
        ("vertical", vertical, exact(vertical_violation, sz, vz, zthr, tcoa)),
        ("combined", both, exact(violation, s, v, sz, vz, dthr, zthr, tthr, tcoa)),
        (
            "combined, seen from the intruder",
            both,
            exact(violation, back_s, back_v, -sz, -vz, dthr, zthr, tthr, tcoa),
        ),
    )
    wrong = [(what, wanted, got) for what, wanted, got in rows if bool(got) is not wanted]
    if not wrong:
        return passed(name, len(rows))
    what, wanted, got = wrong[0]
    kind = case.get("kind", "")
    text = f"{what}: expected {_word(wanted)}, got {_word(bool(got))}; s = {(sx, sy, sz)} m, "
    text += f"v = {(vx, vy, vz)} m/s, DTHR {dthr} m, ZTHR {zthr} m, TTHR {tthr} s, TCOA {tcoa} s"
    return failed(name, f"{what} {_word(wanted)} missed ({kind})", text, len(rows))


def _word(violated: bool) -> str:
    return "violated" if violated else "clear"
