"""Commands to one vehicle as text of the mission: a place, an altitude, or neither, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cratous.services.ground_station.live_session import NotObeyed
from cratous.services.loading.document import parse_document
from cratous.services.loading.yaml_mission import loaded
from cratous.services.mission_editor.operator_commands import HEAD, directed
from cratous.spec.errors import BadInput
from cratous.spec.mission import Change
from cratous.spec.mission.changes import HoldCommand

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "examples" / "crossing" / "mission.yaml").read_text(encoding="utf-8")


def test_a_direct_command_is_of_one_vehicle_and_asks_for_nothing_else() -> None:
    at = directed(
        TEXT, "m.yaml", 0, 24_250, {"what": "hold_at", "vehicle": 2, "places": [[9.96, -5]]}
    )
    assert at.text.startswith(HEAD)
    (hold,) = at.mission.changes
    assert hold == HoldCommand(24_250, "vehicle_holds", vehicle=2, place=(10.0, -5.0))
    here = directed(at.text, "m.yaml", 0, 30_000, {"what": "hold_here", "vehicle": 1})
    again = directed(here.text, "m.yaml", 0, 31_000, {"what": "resume", "vehicle": 2})
    assert again.text.count(HEAD) == 1
    assert again.mission == loaded(parse_document(again.text, "m.yaml"))
    assert again.mission.changes == (
        hold,
        HoldCommand(30_000, "vehicle_holds", vehicle=1),
        Change(31_000, "vehicle_resumes", vehicle=2),
    )
    high = {"what": "hold_here", "vehicle": 2, "alt_m": 320.04}
    (one,) = directed(TEXT, "m.yaml", 0, 24_000, high).mission.changes
    assert one == HoldCommand(24_000, "vehicle_holds", vehicle=2, alt_m=320.0)
    # a variant of the mission has the place where it was clicked
    varied = directed(
        TEXT, "m.yaml", 7, 24_250, {"what": "hold_at", "vehicle": 2, "places": [[9, 9]]}
    )
    (change,) = varied.mission.changes
    assert isinstance(change, HoldCommand)
    assert change.place == (9.0, 9.0)


@pytest.mark.parametrize(
    ("asked", "error"),
    [
        (None, NotObeyed), ({"what": "go_to", "vehicle": 1, "places": [[0, 0]]}, NotObeyed),
        ({"what": "resume"}, NotObeyed), ({"what": "resume", "vehicle": 7}, NotObeyed),
        ({"what": "resume", "vehicle": True}, NotObeyed),
        ({"what": "hold_at", "vehicle": 1}, NotObeyed),
        ({"what": "hold_at", "vehicle": 1, "places": [[0, 0], [1, 1]]}, NotObeyed),
        ({"what": "hold_at", "vehicle": 1, "places": [[0, 900_000]]}, BadInput),
        ({"what": "hold_here", "vehicle": 1, "alt_m": "320"}, NotObeyed),
        ({"what": "hold_here", "vehicle": 1, "alt_m": True}, NotObeyed),
        ({"what": "hold_here", "vehicle": 1, "alt_m": None}, NotObeyed),
        ({"what": "hold_here", "vehicle": 1, "alt_m": float("nan")}, NotObeyed),
        ({"what": "hold_here", "vehicle": 1, "alt_m": 1e6}, NotObeyed),
        ({"what": "hold_here", "vehicle": 1, "alt_m": 10}, BadInput),
    ],
)  # fmt: skip
def test_what_is_no_direct_command_is_refused(asked: Any, error: type[Exception]) -> None:
    with pytest.raises(error):
        directed(TEXT, "m.yaml", 0, 24_000, asked)
