"""SerialAutomationRequestTestService alone on a bus: one request at a time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import Rig, request

from cratous.bridge import lmcp

SERIAL = "SerialAutomationRequestTestService"


def passed(rig: Rig) -> list[Any]:
    """The tasks of what has gone out."""
    sent = [e.body for e in rig.all if e.address == "UniqueAutomationRequest"]
    return [getattr(b, "TrialRequest", b).TaskList[0] for b in sent]


@pytest.mark.shows(
    SERIAL,
    "AutomationRequest",
    "ImpactAutomationRequest",
    "AutomationResponse",
    "ImpactAutomationResponse",
)
def test_the_next_request_goes_out_when_the_one_before_is_answered(tmp_path: Path) -> None:
    rig = Rig(tmp_path, SERIAL)
    trial = lmcp.new("ImpactAutomationRequest", TrialRequest=request(2))
    rig.tell(request(1), trial, request(3))
    assert passed(rig) == [1]
    rig.tell(lmcp.new("AutomationResponse"))
    assert passed(rig) == [1, 2]
    rig.tell(lmcp.new("ImpactAutomationResponse", TrialResponse=lmcp.new("AutomationResponse")))
    rig.tell(lmcp.new("AutomationResponse"), request(4))
    assert passed(rig) == [1, 2, 3, 4]


@pytest.mark.shows(SERIAL, "MaxResponseTime_ms")
def test_an_answer_that_does_not_come_is_waited_for_a_while(tmp_path: Path) -> None:
    rig = Rig(tmp_path, SERIAL, **{SERIAL: 'MaxResponseTime_ms="700"'})
    rig.tell(request(1), request(2), request(3))
    rig.wait(600)
    assert passed(rig) == [1]
    rig.tell(lmcp.new("AutomationResponse"))
    rig.wait(600)  # the time of the first one is over, and the second is new
    assert passed(rig) == [1, 2]
    rig.wait(200)
    assert passed(rig) == [1, 2, 3]
