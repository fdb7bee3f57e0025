"""The assumptions of the theorems on the composed system, and what was observed of each in a run."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from cratous.services.argument.elements import Element, Kind
from cratous.services.assumptions.observation_texts import measured
from cratous.spec.errors import BadInput

Data = dict[str, Any]
SECTION = "assumptions"
HELD, BROKEN = "held", "broken"
FOLDERS = ("", "system_", "permit_")
"""Prefixes of theorem names: the listing has names without a folder, records have the folder's prefix."""
AUTHORITY = (
    "system_authority_starts_as_it_must_be",
    "system_authority_is_kept_by_the_gate",
    "system_authority_is_kept_by_icarous",
    "system_authority_is_kept_by_the_uxas_end",
)
_, GATE, _, UXAS_END = AUTHORITY
TAKEOVER_ENDS = "system_a_takeover_whose_way_back_stays_free_ends"
TAKEOVER_LASTS = "system_a_takeover_that_lasts_is_declared"
MISSION_ENDS = "system_a_mission_ends"
SILENCE = "system_silence_is_noticed_within_one_heartbeat"
HAND = "system_the_hand_is_clear_until_a_surprise_or_its_expiry"
CLEAR = "system_a_vehicle_is_clear_until_a_surprise_or_an_expiry"
LOOKED = "system_a_way_that_is_looked_ahead_at_is_clear"
FENCED = "system_no_zone_is_entered_until_a_surprise_or_an_expiry"
NEAR_LEGS = "system_whoever_is_near_a_checked_leg_obeys_the_zones"
RANK = "system_the_rank_of_a_mission_falls_at_each_heartbeat"
SERVED = "system_a_chain_is_served_where_takeovers_and_stays_are_bounded"
FEW = "system_uxas_counts_a_takeover_once_for_each_intruder_and_surprise"
BEARS_ON: dict[str, tuple[str, ...]] = {
    "G1": (FENCED, NEAR_LEGS, HAND),
    "G2": (CLEAR, LOOKED, HAND),
    "G3": (MISSION_ENDS, RANK, TAKEOVER_LASTS, SERVED, FEW),
    "G4": (*AUTHORITY, TAKEOVER_ENDS, TAKEOVER_LASTS),
    "G5": (SILENCE,),
}
"""The theorems on the composed system that support each guarantee."""
UP_TO = {
    "G1": "its theorems speak of zones alone: while UxAS flies, near legs that keep them; while ICAROUS does, up to the "
    "first surprise, declaration or expiry",
    "G2": "its theorems speak of the cylinder of the volume alone, of what is seen, and up to the first surprise, "
    "declaration or expiry",
}
"""How far the theorems cover a guarantee, if not completely."""
PLACED = frozenset(name for names in BEARS_ON.values() for name in names)


class Assumed(NamedTuple):
    """An assumption in a run. theorems: those that need it; guarantees: those it concerns; watched:
    observation in words; broken: in words, empty unless it broke.
    """

    text: str
    theorems: frozenset[str]
    guarantees: frozenset[str]
    watched: str
    broken: str = ""


def assumed(report: Data) -> list[Assumed]:
    """The assumptions of a run, in report order. Raises BadInput for a report without them."""
    if SECTION not in report:
        raise BadInput(
            "the report says nothing of assumptions",
            item=SECTION,
            expected="a report of a version that watches them",
        )
    return [_of_report(row) for row in report[SECTION]]


def _of_report(row: Data) -> Assumed:
    state, note = row["state"], row["note"]
    when = f" at {row['since_ms'] / 1000:.2f} s" if state == BROKEN else ""
    said = f"{state}{when}{f': {note}' if note else ''}"
    said += f" ({worst})" if (worst := measured(row)) else ""
    # any other value counts as not watched
    word = "Watched" if state in (HELD, BROKEN) else "Not watched"
    names = frozenset(f"{folder}{name}" for name in row["theorems"] for folder in FOLDERS)
    return Assumed(
        row["text"],
        names,
        frozenset(row["guarantees"]),
        f"{word} in this run: {said}",
        said if state == BROKEN else "",
    )


def elements(found: list[Assumed]) -> Iterator[Element]:
    """An element for each assumption, in order."""
    for number, one in enumerate(found, 1):
        yield Element(f"A-{number}", Kind.ASSUMPTION, f"{one.text}. {one.watched}")
