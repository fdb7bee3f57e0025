"""How often the watches of late heartbeats look."""

from __future__ import annotations

from typing import Any

from flight_tools import meeting

from cratous.bridge import lmcp
from cratous.services.assumptions.link import DeliveryWatch, PeriodWatch
from cratous.services.assumptions.observed import Message
from cratous.services.assumptions.watch import AssumptionWatch

MISSION = meeting()


def test_of_one_instant_is_looked_at_once_unless_a_heartbeat_came_in_it() -> None:
    state = lmcp.new("TruthState", VehicleID=1)
    first = lmcp.new("Heartbeat", VehicleID=1, Direction="Up", Sequence=1)
    watch, period = DeliveryWatch(MISSION), PeriodWatch(MISSION)
    for now_ms, kind, body in (
        (2500, "TruthState", state), (2500, "TruthState", state), (2500, "Heartbeat", first),
    ):  # fmt: skip
        for one in (watch, period):
            one.message(Message(kind, now_ms, "", body))
    (delivery,), (told,) = watch.records().values(), period.records().values()
    assert told.checks == 1
    # the first was late, then came late, and the second is late as well
    assert delivery.checks == 3


class _Closed:
    """A body that nobody may look into."""

    def __getattr__(self, name: str) -> Any:
        raise AssertionError(name)


def test_from_messages_of_other_types_nothing_follows() -> None:
    """So a watch need not be told of them."""
    kinds = ("TruthState", "Heartbeat", "GateState", "GatedCommand", "TaskProgress", "SensedState", "AuthorityChange",
             "MissionCommand", "AirVehicleState", "BridgeStatus")  # fmt: skip
    others = 0
    for one in AssumptionWatch(MISSION)._watches:
        before = repr(vars(one))
        for kind in kinds:
            if one.kinds and kind not in one.kinds:
                one.message(Message(kind, 10**7, "", _Closed()))
                others += 1
        assert repr(vars(one)) == before
    assert others > 50
