"""G1 of vehicles that merge: does any vehicle pass the fix too soon after another? Exact, also between samples.

Each stay of a vehicle in the entry zone, the closed disc about the fix, is one passage, at the first instant at
which it is nearest to the fix. On a leg a + t v that is t = -a.v / |v|^2, clipped to the leg: a rational number,
without a square root. Where one of the two did not pass, nothing can be compared, and the row is unknown.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import combinations

from cratous.judge.log import State
from cratous.judge.mission import Mission
from cratous.judge.sites import Fix
from cratous.judge.tracks import Track
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, seconds


def rows(mission: Mission, flown: dict[int, Track]) -> Iterator[Row]:
    """One row for each pair of vehicles that merge."""
    fix = mission.fix
    if fix is None:
        return
    passed = {n: passages(fix, flown[n]) for n in sorted(fix.vehicles)}
    for one, other in combinations(passed, 2):
        yield _row(fix, (one, other), passed, flown)


def _row(
    fix: Fix,
    pair: tuple[int, int],
    passed: dict[int, list[Fraction]],
    flown: dict[int, Track],
) -> Row:
    one, other = pair
    subject, item = (
        ("merge", str(one), str(other)),
        f"separation at {fix.name}: vehicles {one} and {other}",
    )
    gaps = [(abs(a - b), max(a, b)) for a in passed[one] for b in passed[other]]
    note = "; ".join(_words(number, passed[number]) for number in pair)
    near = [(at, gap) for gap, at in gaps if gap < fix.separation_ms]
    if near:
        at, gap = min(near)
        note = f"{float(gap) / 1000:.2f} s after the other one; {note}"
        return Row("G1", subject, item, VIOLATED, note, int(at), len(gaps))
    doubts = [flown[n].doubt for n in pair if flown[n].doubt]
    if not gaps:
        doubts.append("nothing to compare")
    if doubts:
        return Row("G1", subject, item, UNKNOWN, f"{doubts[0]}; {note}", None, len(gaps))
    return Row("G1", subject, item, HOLDS, note, None, len(gaps))


def _words(number: int, at: list[Fraction]) -> str:
    when = " and ".join(seconds(float(time)) for time in at)
    return f"{number} passed at {when}" if at else f"{number} did not pass"


def passages(fix: Fix, track: Track) -> list[Fraction]:
    """When a vehicle passed the fix [ms]."""
    found, least, inside = list[Fraction](), Fraction(0), False
    reach = Fraction(fix.entry_m) ** 2
    for before, after in track.legs():
        squared, at = _nearest(fix, before, after)
        if squared > reach:
            inside = False
            continue
        if not inside:
            found.append(at)
            least = squared
        elif squared < least:
            found[-1], least = at, squared
        inside = True
    return found


def _nearest(fix: Fix, before: State, after: State) -> tuple[Fraction, Fraction]:
    """The square of the least distance from the fix on a leg [m2], and its time [ms]."""
    north = Fraction(before.north_m) - Fraction(fix.north_m)
    east = Fraction(before.east_m) - Fraction(fix.east_m)
    moved_n, moved_e = (Fraction(after[k]) - Fraction(before[k]) for k in (1, 2))
    length = moved_n * moved_n + moved_e * moved_e
    share = Fraction(0)
    if length:
        share = min(max(-(north * moved_n + east * moved_e) / length, Fraction(0)), Fraction(1))
    north, east = north + share * moved_n, east + share * moved_e
    return north * north + east * east, before.time_ms + share * (after.time_ms - before.time_ms)
