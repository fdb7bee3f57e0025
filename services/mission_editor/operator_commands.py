"""Operator commands in flight, as changes of the mission's text that become known at the next step.

Requests for other tasks or zones concern the whole mission; direct commands concern one vehicle,
and change nothing that is requested.

So a flight with commands is the flight of that text: flown again, it gives the same log. Requests
are planned like any other change, and checked when the text is read.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cratous.services.ground_station.direct_orders import Directed
from cratous.services.ground_station.live_session import NotObeyed
from cratous.services.loading.document import parse_document
from cratous.services.loading.yaml_mission import loaded
from cratous.services.mission_editor.text_edits import MissionText
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission

KEEP_OUT, GO_TO, LOITER, DROP, END_ZONE = KINDS = (
    "keep_out", "go_to", "loiter", "drop_task", "end_zone",
)  # fmt: skip
HOLD_AT, HOLD_HERE, RESUME = DIRECT = ("hold_at", "hold_here", "resume")
"""Executed by the running flight, without flying it again."""
LABEL = "by the operator"
MOST_CORNERS, FARTHEST_M, LONGEST_S = 38, 1e7, 86_400.0
"""Limits of a command: corners (as many as fit into a request, however far away), distance [m], and
duration [s].
"""
LOWEST_M, HIGHEST_M = -1000.0, 100_000.0
"""Limits of altitudes in a mission file [m]."""
NO_VEHICLE = "expected vehicle: the id of one of the mission"
HEAD = "# Commanded by the operator in flight; this file flown again gives the same log.\n"


class Commanded(NamedTuple):
    """text: of the mission with the command; at_ms: time at which it becomes known; what: the command in words."""

    text: str
    at_ms: int
    what: str


def commanded(text: str, where: str, seed: int, now_ms: int, asked: Any) -> Commanded:
    """The mission with one more command, which becomes known one step after now_ms.

    asked: `what`, and depending on it `places` ([north, east] [m]), `vehicle`, `alt_m` (above mean
    sea level, optional), `duration_s` or `id`. Raises NotObeyed for an invalid command, and
    BadInput if the mission cannot have it.
    """
    if not isinstance(asked, dict) or asked.get("what") not in KINDS:
        raise NotObeyed(400, f"expected what: one of {', '.join(KINDS)}")
    step_ms = loaded(parse_document(text, where), seed).simulation.step_ms
    at_ms = (now_ms // step_ms + 1) * step_ms
    what, at_s = asked["what"], at_ms / 1000
    mission = MissionText(text, where)
    found: dict[str, Any]
    if what == DROP:
        found, said = {"task_removed": _id(asked)}, f"task {_id(asked)} is dropped"
    elif what == END_ZONE:
        found, said = {"zone_ends": _id(asked)}, f"zone {_id(asked)} ends"
    elif what == KEEP_OUT:
        number, corners = _next_zone(mission), _places(asked, 3, MOST_CORNERS)
        zone = {"id": number, "kind": KEEP_OUT, "label": LABEL, "vertices": corners}
        found, said = {"zone": zone}, f"keep-out zone {number}"
    else:
        mission, number = _with_task(mission, what, asked)
        found, said = {"task_added": number}, f"task {number} for vehicle {asked['vehicle']}"
    new = mission.added("changes", {"at_s": at_s, **found})
    new = _headed(new)
    _refuse_moved(loaded(parse_document(new, where), seed), found, asked)
    return Commanded(new, at_ms, f"{said}, commanded at {at_s:g} s")


def directed(text: str, where: str, seed: int, at_ms: int, asked: Any) -> Directed:
    """The mission with one more direct command, which becomes known at at_ms, a step of the flight.

    asked: `what`, `vehicle`, for HOLD_AT one of `places`, and for both holds an optional `alt_m`.
    Raises NotObeyed and BadInput as `commanded`.
    """
    what = asked.get("what") if isinstance(asked, dict) else None
    if what not in DIRECT:
        raise NotObeyed(400, f"expected what: one of {', '.join(DIRECT)}")
    mission = MissionText(text, where)
    vehicle = asked.get("vehicle")
    if type(vehicle) is not int or all(one["id"] != vehicle for one in mission.data["vehicles"]):
        raise NotObeyed(400, NO_VEHICLE)
    found: dict[str, Any] = {"vehicle_resumes": vehicle}
    if what != RESUME:
        found = {"vehicle_holds": {"vehicle": vehicle, **_altitude(asked)}}
    if what == HOLD_AT:
        (found["vehicle_holds"]["place"],) = _places(asked, 1, 1)
    new = _headed(mission.added("changes", {"at_s": at_ms / 1000, **found}))
    return Directed(new, loaded(parse_document(new, where), seed))


def _headed(text: str) -> str:
    return text if text.startswith(HEAD) else HEAD + text


def _refuse_moved(mission: Mission, found: dict[str, Any], asked: dict[str, Any]) -> None:
    """Raises BadInput if the seeded variant moves the commanded object to another place."""
    places: Any = ()
    if "task_added" in found:
        places = next(task.points for task in mission.tasks if task.id == found["task_added"])
    elif "zone" in found:
        places = next(
            c.zone.vertices for c in mission.changes if c.zone and c.zone.id == found["zone"]["id"]
        )
    for place, wanted in zip(places, asked.get("places", ()), strict=False):
        if [round(x - y, 1) for x, y in zip(place[:2], wanted, strict=True)] != [0, 0]:
            raise BadInput(
                "the variant of this mission has tasks and zones at other places than its file",
                where=mission.source, item="--seed", expected="0, for commands that name a place",
                got=str(mission.seed),
            )  # fmt: skip


def _with_task(mission: MissionText, what: str, asked: dict[str, Any]) -> tuple[MissionText, int]:
    """The text with a task for one vehicle at a place, at the requested altitude or that at its
    start; and its id.
    """
    vehicle = asked.get("vehicle")
    start = next((v for v in mission.data["vehicles"] if v["id"] == vehicle), None)
    if type(vehicle) is not int or start is None:
        raise NotObeyed(400, NO_VEHICLE)
    ((north_m, east_m),) = _places(asked, 1, 1)
    place = {"north_m": north_m, "east_m": east_m, "alt_m": start["position"]["alt_m"]}
    place |= _altitude(asked)
    number = max((one["id"] for one in mission.data["tasks"]), default=0) + 1
    task: dict[str, Any] = {
        "id": number, "kind": "must_fly", "label": LABEL, "eligible": [vehicle], "points": [place],
    }  # fmt: skip
    if what == LOITER:
        task |= {"kind": LOITER, "duration_s": _seconds(asked)}
    relations = mission.data.get("relations") or ""
    text = mission.added("tasks", task)
    if relations.strip():
        text = MissionText(text, mission.where).put(("relations",), f"|({relations} p{number})")
    return MissionText(text, mission.where), number


def _id(asked: dict[str, Any]) -> int:
    if type(number := asked.get("id")) is not int:
        raise NotObeyed(400, "expected id: a number")
    return number


def _seconds(asked: dict[str, Any]) -> float:
    value: Any = asked.get("duration_s")
    if type(value) not in (int, float) or not 0 < value <= LONGEST_S:
        raise NotObeyed(400, f"expected duration_s: more than 0, {LONGEST_S:g} at most")
    return float(value)


def _altitude(asked: dict[str, Any]) -> dict[str, float]:
    """The requested altitude [m above mean sea level], to a decimetre; empty if none."""
    if "alt_m" not in asked:
        return {}
    value: Any = asked["alt_m"]
    if type(value) not in (int, float) or not LOWEST_M <= value <= HIGHEST_M:
        raise NotObeyed(400, f"expected alt_m: {LOWEST_M:g} to {HIGHEST_M:g}, in metres")
    return {"alt_m": round(float(value), 1)}


def _places(asked: dict[str, Any], least: int, most: int) -> list[list[float]]:
    """Positions [m], to a decimetre."""
    places: Any = asked.get("places")
    if not isinstance(places, list) or not least <= len(places) <= most:
        raise NotObeyed(400, f"expected places: {least} to {most} of [north, east]")
    found = []
    for one in places:
        if not isinstance(one, list) or len(one) != 2 or not all(map(_is_place, one)):
            raise NotObeyed(400, "expected places of [north, east], in metres")
        found.append([round(float(x), 1) for x in one])
    return found


def _is_place(value: Any) -> bool:
    number = type(value) in (int, float)
    return number and math.isfinite(value) and abs(value) < FARTHEST_M


def _next_zone(mission: MissionText) -> int:
    zones = [*(mission.data.get("zones") or ())]
    zones += [c["zone"] for c in mission.data.get("changes") or () if "zone" in c]
    return max((zone["id"] for zone in zones), default=0) + 1
