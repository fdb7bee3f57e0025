"""How often the watches of late heartbeats look."""

from __future__ import annotations

from typing import Any

from flight_tools import meeting
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import lmcp
from cratous.services.assumptions.link import DeliveryWatch, PeriodWatch
from cratous.services.assumptions.listing import State
from cratous.services.assumptions.observations import Message
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


@given(
    st.lists(
        st.one_of(st.none(), st.integers(0, 6).map(lambda k: 250 * k)), min_size=1, max_size=12
    ),
    st.integers(0, 30),
)
def test_delivery_is_what_its_sentence_says(delays: list[int | None], end: int) -> None:
    """A heartbeat is late if there is one that had two periods until the end, and did not come in them."""
    end_ms = 250 * end
    watch = DeliveryWatch(MISSION)
    came = [
        (500 * k + delay, k + 1)
        for k, delay in enumerate(delays)
        if delay is not None and 500 * k + delay <= end_ms
    ]
    for now_ms, number in sorted(came):
        body = lmcp.new("Heartbeat", VehicleID=1, Time=now_ms, Direction="Up", Sequence=number)
        watch.message(Message("Heartbeat", now_ms, "uxas/ics", body))
    watch.end(end_ms)
    (record,) = watch.records().values()
    sent = [*delays, *[None] * 40]
    late = any(
        500 * k + 1000 < end_ms and (delay is None or delay > 1000) for k, delay in enumerate(sent)
    )
    broken = record.observed(end_ms, True).state is State.BROKEN
    assert broken == late
