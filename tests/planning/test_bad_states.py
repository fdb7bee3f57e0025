"""States that are none: a request is answered all the same, with what is wrong or without what is not needed."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from following_tools import aircraft, moving
from pipeline_tools import Rig, must_fly, place, request


@pytest.mark.parametrize(
    "bad", [{"Location": place(1e30)}, {"Location": place(0.0, math.nan)}, {"Heading": math.inf}]
)
def test_a_bad_state_of_another_keeps_nobody_from_planning(
    tmp_path: Path, bad: dict[str, Any]
) -> None:
    rig = Rig(tmp_path)
    configuration, state = moving()
    rig.tell(*aircraft(1, 0.02), configuration, state.copy(**bad), must_fly(5), request(5))
    assert not [line for line in rig.said if "fails" in line], rig.said
    assert rig.got("AutomationResponse")[-1].MissionCommandList


@pytest.mark.parametrize(
    ("bad", "reason"),
    [
        ({"Heading": math.nan}, "Heading: not a heading; expected a finite number; got nan"),
        ({"Heading": -math.inf}, "Heading: not a heading; expected a finite number; got -inf"),
        ({"Location": place(89.5)}, "Location: not a place"),
        ({"Location": place(0.0).copy(Altitude=1e9)}, "an altitude from -1000 to 100000 m; got"),
    ],
)
def test_a_vehicle_with_a_bad_state_is_refused_with_the_reason(
    tmp_path: Path, bad: dict[str, Any], reason: str
) -> None:
    rig = Rig(tmp_path)
    configuration, state = aircraft(1, 0.02)
    rig.tell(configuration, state.copy(**bad), must_fly(5), request(5))
    assert not [line for line in rig.said if "fails" in line], rig.said
    assert any(reason in text for text in rig.reasons()), rig.reasons()
