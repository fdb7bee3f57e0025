"""The assumptions of the system theorems: which theorems depend on each, and what is lost when it
breaks.

`docs/proofs/assumptions.md` has the same rows; a test compares them.
"""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

AUTHORITY = (
    "authority_starts_as_it_must_be",
    "authority_is_kept_by_the_gate",
    "authority_is_kept_by_icarous",
    "authority_is_kept_by_the_uxas_end",
)
GATE, UXAS_END = AUTHORITY[1:2], AUTHORITY[3:4]
TAKEOVER_ENDS = ("a_takeover_whose_way_back_stays_free_ends",)
SILENCE = ("silence_is_noticed_within_one_heartbeat",)
PERMIT = ("permitted_has_no_hit", "disc_within_holds_every_place")
HAND = ("the_hand_is_clear_until_a_surprise_or_its_expiry",)
CLEAR = ("a_vehicle_is_clear_until_a_surprise_or_an_expiry",)
LOOKED = ("a_way_that_is_looked_ahead_at_is_clear",)
FENCED = ("no_zone_is_entered_until_a_surprise_or_an_expiry",)
RANK = ("the_rank_of_a_mission_falls_at_each_heartbeat",)
SERVED = ("a_chain_is_served_where_takeovers_and_stays_are_bounded",)
FEW = ("uxas_counts_a_takeover_once_for_each_intruder_and_surprise",)
NEAR_LEGS = ("whoever_is_near_a_checked_leg_obeys_the_zones",)
ONE_COMMANDER = "exactly one commander at any time"
REPLAYED = "the replay of the gate (G4) judges each command and each report by itself"
SAMPLED = (
    "well clear (G2) and zones (G1) are judged from where the aircraft were, not from predictions"
)
BY_EPOCH = "one commander at any time: it needs no clock and no delivery"


class State(StrEnum):
    """The three results. What was not observed to the end of the mission is not observed, never held."""

    HELD = "held"
    BROKEN = "broken"
    NOT_OBSERVED = "not observed"


class Assumption(NamedTuple):
    """text: what is assumed; theorems: files of `proofs/theorems` (system or permit); guarantees:
    G1 to G5; lost: what is no longer guaranteed when it breaks; stands: what still holds then;
    watch: what is observed in a flight.
    """

    name: str
    text: str
    theorems: tuple[str, ...]
    guarantees: tuple[str, ...]
    lost: str
    stands: str
    watch: str


LISTING = (
    Assumption(
        "first command",
        "UxAS commands first, in epoch 0",
        AUTHORITY,
        ("G4",),
        ONE_COMMANDER,
        REPLAYED,
        "the first command of each protected vehicle",
    ),
    Assumption(
        "reports of the gate",
        "a report of the gate is one that the vehicle has made",
        (*UXAS_END, *FEW),
        ("G3", "G4"),
        "that UxAS believes of the gate what is so",
        REPLAYED,
        "who sends each report",
    ),
    Assumption(
        "epochs told",
        "a command names an epoch that its sender has been told",
        GATE,
        ("G4",),
        "that no command of a later epoch is waiting for the gate",
        "such a command does not act while the gate is in an earlier epoch",
        "commands of epochs that the gate has never given",
    ),
    Assumption(
        "epochs kept",
        "the gate keeps its epoch (no restart that forgets it)",
        (*AUTHORITY, *FEW),
        ("G3", "G4"),
        "that a late command of an earlier epoch does not act",
        REPLAYED,
        "epochs that go back",
    ),
    Assumption(
        "commands by the gate alone",
        "a vehicle gets no command but by its gate",
        (*GATE, *CLEAR, *FENCED),
        ("G1", "G2", "G4"),
        ONE_COMMANDER,
        SAMPLED,
        "commands to a vehicle outside of `GatedCommand`",
    ),
    Assumption(
        "ICAROUS at each heartbeat",
        "ICAROUS looks at the gate at each heartbeat before it does anything",
        (*GATE, *CLEAR, *FENCED, *FEW),
        ("G1", "G2", "G3", "G4"),
        "that ICAROUS commands while it has the vehicle",
        BY_EPOCH,
        "the longest time between its commands while it has the vehicle",
    ),
    Assumption(
        "suspended",
        "UxAS commands nothing while it is suspended",
        UXAS_END,
        ("G4",),
        "that UxAS does what its end of the link believes",
        "its command does not act: the gate is in a later epoch",
        "commands of the executive after a task was suspended and before the vehicle is taken back",
    ),
    Assumption(
        "clock",
        "the clock of one end does not step back",
        (*SILENCE, *HAND, *CLEAR, *FENCED),
        ("G1", "G2", "G4", "G5"),
        "that silence is noticed within one heartbeat, and every bound in time",
        BY_EPOCH,
        "times of messages",
    ),
    Assumption(
        "heartbeat period",
        "heartbeats are at most a period apart",
        (*SILENCE, *TAKEOVER_ENDS),
        ("G4", "G5"),
        "that silence is noticed within one heartbeat, and that a takeover ends within its bound",
        BY_EPOCH,
        "the longest time between heartbeats that UxAS sends to an ICAROUS",
    ),
    Assumption(
        "delivery from ICAROUS",
        "each line from ICAROUS to UxAS is delivered within two heartbeats",
        TAKEOVER_ENDS,
        ("G4", "G5"),
        "that a takeover ends within its bound; bounded delay",
        BY_EPOCH,
        "heartbeats by their numbers: the k-th is sent k - 1 periods after the start",
    ),
    Assumption(
        "delivery to ICAROUS",
        "at each heartbeat of ICAROUS a line from UxAS has been delivered to it in the last two seconds",
        TAKEOVER_ENDS,
        ("G4", "G5"),
        "that a takeover ends within its bound: what is not heard is offered nothing",
        BY_EPOCH,
        "what each ICAROUS says of it: when it no longer hears UxAS, and since when",
    ),
    Assumption(
        "offers taken",
        "an offer reaches UxAS, and its command the gate, within two heartbeats each",
        TAKEOVER_ENDS,
        ("G4",),
        "that a takeover ends within its bound",
        BY_EPOCH,
        "how long an offer stays open",
    ),
    Assumption(
        "takeovers told",
        "a change of authority reaches UxAS within two heartbeats",
        TAKEOVER_ENDS,
        ("G4", "G5"),
        "that a takeover ends within its bound; bounded delay",
        "a command of an epoch that is over does not act",
        "commands that UxAS sends in an epoch that is over: for how long it has been",
    ),
    Assumption(
        "way back free",
        "the way back is free from some heartbeat on, at each",
        TAKEOVER_ENDS,
        ("G4",),
        "that a takeover ends within its bound, or at all",
        "the limit ends the mission, and G4 counts a takeover that is open then",
        "takeovers that are open at the end: for how long ICAROUS, which hears UxAS, has offered nothing",
    ),
    Assumption(
        "end of the flight",
        "the executive asks `flight_outcome` at the end of each step",
        ("a_mission_ends", "a_takeover_that_lasts_is_declared", *SERVED),
        ("G3", "G4"),
        "that the mission ends by its limit, served or declared",
        "G3 counts what was served",
        "the last message: none after the limit and one step",
    ),
    Assumption(
        "vehicles away counted",
        "the executive counts the vehicles that are away by their gates",
        ("a_mission_ends", "a_takeover_that_lasts_is_declared"),
        ("G3", "G4"),
        "that a takeover that lasts is declared, and that the mission ends as it says",
        "G4 counts a takeover that is open at the end",
        "who has each vehicle as the flight ends before its limit: none in the air is under ICAROUS",
    ),
    Assumption(
        "settled tasks",
        "another plan brings no task back that has ended or failed",
        ("a_mission_ends", *RANK, *SERVED),
        ("G3",),
        "that less is left after each step, so that the mission ends before its limit",
        "the limit ends the mission; G3 counts what was served",
        "tasks that begin, or are on their way, after they were complete or had failed",
    ),
    Assumption(
        "items given up",
        "the executive counts each takeover on an item, at most one between two heartbeats, and asks `leg_given_up` at each",
        (*RANK, *SERVED, *FEW),
        ("G3",),
        "that less is left at each heartbeat, so that takeovers on an item have an end",
        "the limit ends the mission; G3 counts what was served",
        "takeovers on the way to each item and the time under ICAROUS: no more than are allowed, one between two heartbeats",
    ),
    Assumption(
        "stays bounded",
        "on each item of a chain, takeovers stay within the allowed number, and the time that ICAROUS may take covers its "
        "longest stay on any item, times one more than the most takeovers on one item",
        SERVED,
        ("G3",),
        "that no item is given up for what ICAROUS flies, so that each is served",
        "the mission ends, served or declared; G3 counts what was served",
        "the most takeovers and withdrawn offers on the way to one item, and one more, times the longest stay on any",
    ),
    Assumption(
        "flown in time",
        "UxAS flies each chain so soon that with the longest stays of ICAROUS at all of its items it ends before the limit",
        SERVED,
        ("G3",),
        "that each chain is at its end before the limit",
        "the limit ends the mission; G3 counts what was served",
        "how long UxAS flies each chain, and beside it the longest stay, as often as takeovers come on one item and once "
        "more, on each of its items",
    ),
    Assumption(
        "no other failure",
        "no task fails but one whose item is given up: each is planned, has a way, and can keep its deadlines",
        SERVED,
        ("G3",),
        "that each item is served",
        "the mission ends, served or declared; G3 counts what was served",
        "tasks that fail, and why; tasks that are not seen to their end",
    ),
    Assumption(
        "intruder in its tube",
        "an intruder that a takeover avoids flies straight on, within half of what the buffer leaves",
        (*PERMIT, *CLEAR),
        ("G2",),
        "that what ICAROUS flies is clear of this intruder, by the prediction of the takeover",
        SAMPLED,
        "the intruder named by the takeover: how far it is from its straight prediction, made at the takeover and "
        "after each look-ahead anew",
    ),
    Assumption(
        "tracking",
        "a vehicle under ICAROUS flies the path that is predicted, within half of what the buffer leaves",
        (*PERMIT, *CLEAR, *FENCED),
        ("G1", "G2"),
        "that what ICAROUS flies is clear, by its predictions",
        SAMPLED,
        "how far it is, up to the next heartbeat, from the path that its last command gives (the path beyond is "
        "not in the log)",
    ),
    Assumption(
        "sensed within its bound",
        "an aircraft is no farther from what was sensed of it than the bound that its track declares",
        (*PERMIT, *CLEAR),
        ("G2",),
        "that what ICAROUS keeps clear of holds the true places",
        SAMPLED,
        "each state that was sensed, at each heartbeat: how far from it the true one is, as a share of the bound",
    ),
    Assumption(
        "flown as looked at",
        "up to the next heartbeat a vehicle under UxAS flies the way that its ICAROUS has looked at, and every other "
        "aircraft straight on or as was told, each within half of what the buffer leaves",
        (*CLEAR, *LOOKED),
        ("G2",),
        "that what UxAS flies is clear, by the last look at its way",
        SAMPLED,
        "each aircraft from heartbeat to heartbeat: how far it is from flying straight on (the way that is looked at is "
        "not in the log)",
    ),
    Assumption(
        "near its legs",
        "a vehicle under UxAS flies no farther from a leg that it was commanded, to the side, above or below, than a margin "
        "by which the leg keeps every zone",
        (*FENCED, *NEAR_LEGS),
        ("G1",),
        "that what UxAS flies keeps the zones at every instant, by the legs that it was commanded",
        SAMPLED,
        "every flight between two samples: how far both ends are from one of the legs, and whether it keeps by that margin "
        "each zone that binds",
    ),
    Assumption(
        "permitted as offered",
        "what is looked at, offered or said to be permitted is what is flown then, and the kernels have found it so, up to "
        "the time that is named",
        (*HAND, *CLEAR, *FENCED),
        ("G1", "G2"),
        "that a vehicle is clear as long as ICAROUS has looked ahead, and until the certificate in hand expires",
        SAMPLED,
        "each sample: no aircraft that is seen in the mission's own cylinder, nor with a certificate in hand a zone broken, "
        "while all others fly as was predicted (what was looked at is not in the log)",
    ),
)
"""All assumptions, in display order."""
