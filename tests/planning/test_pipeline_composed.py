"""The services together, whatever happens to their messages: each request is answered once, in order.

The bus is taken apart: any sender's next message may be delivered next, be lost, or be held back and
come late, and time passes in between. In the end every message that is left is delivered and time
goes on; what the services did is held against the contract.
"""

from __future__ import annotations

import heapq
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pipeline_messages import STEPS
from pipeline_tools import PIPELINE, Rig, loiter, request, vehicle

from cratous.bridge import lmcp
from cratous.services.bus import Envelope

VALIDATOR = "AutomationRequestValidatorService"
LIMIT_MS = 1000
LOSABLE = (*STEPS, "ServiceStatus", "TaskInitialized")


class Unruly:
    """A bus whose messages are delivered one by one, in an order that is chosen."""

    def __init__(self, rig: Rig) -> None:
        self.bus, self.held = rig.bus, []

    def queued(self) -> list[Envelope]:
        """Each sender's first message: one sender's messages stay in their order."""
        first: dict[str, Envelope] = {}
        for envelope in self.bus._queue:
            first.setdefault(envelope.source, envelope)
        return list(first.values())

    def deliver(self, envelope: Envelope) -> None:
        self.bus._queue.remove(envelope)
        envelope = replace(envelope, time_ms=self.bus.now_ms)
        for listener in self.bus._taps:
            listener(envelope)
        for service in self.bus._receivers(envelope):
            if self.bus._here(service) and service.name != envelope.source:
                self.bus._hand(service, envelope)

    def lose(self, envelope: Envelope, hold: bool) -> None:
        """Only what the services tell each other; requests and their responses arrive."""
        if envelope.topic.endswith(LOSABLE):
            self.bus._queue.remove(envelope)
            if hold:
                self.held.append(envelope)

    def let_go(self) -> None:
        """What was held back comes now, late."""
        self.bus._queue.extend(self.held)
        self.held.clear()

    def wait(self, time_ms: int) -> None:
        """Time passes, and who has waited for it is called; nothing is delivered."""
        end = self.bus.now_ms + time_ms
        while self.bus._wakes and self.bus._wakes[0][0] <= end:
            due, _, service, key = heapq.heappop(self.bus._wakes)
            self.bus.now_ms = max(self.bus.now_ms, due)
            self.bus._wake(service, key)
        self.bus.now_ms = end


def trial(number: int, *tasks: int) -> Any:
    return lmcp.new("ImpactAutomationRequest", RequestID=number, TrialRequest=request(*tasks))


ACTIONS = st.lists(
    st.tuples(
        st.sampled_from(["deliver"] * 8 + ["lose", "hold", "release", "wait", "ask", "stray"]),
        st.integers(0, 7),
    ),
    min_size=20,
    max_size=120,
)


@settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow])
@given(ACTIONS, st.randoms(use_true_random=False))
def test_every_request_gets_exactly_one_answer_whatever_happens_to_messages(
    actions: list[tuple[str, int]], random: Any
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        rig = Rig(Path(folder), *PIPELINE, **{VALIDATOR: f'MaxResponseTime_ms="{LIMIT_MS}"'})
        rig.tell(*vehicle(1), *vehicle(2, 0.01), loiter(5), loiter(6, 0.03))
        unruly, asked = Unruly(rig), 0
        for action, number in actions:
            queued = unruly.queued()
            if action == "ask":
                tasks = [(5,), (6,), (5, 6), (7,)][number % 4]  # there is no task 7
                rig.bus.publish(trial(asked, *tasks), "client")
                asked += 1
            elif action == "stray":
                rig.bus.publish(
                    lmcp.new("UniqueAutomationResponse", ResponseID=100 + number), "stray"
                )
            elif action == "release":
                unruly.let_go()
            elif action == "wait":
                unruly.wait([1, 300, LIMIT_MS - 1, LIMIT_MS][number % 4])
            elif queued:
                envelope = queued[number % len(queued)]
                if action == "deliver":
                    unruly.deliver(envelope)
                else:
                    unruly.lose(envelope, action == "hold")
        unruly.let_go()
        rig.bus.run()
        for _ in range(asked + 1):
            rig.wait(LIMIT_MS)
        _hold(rig, asked)


def _hold(rig: Rig, asked: int) -> None:
    """Answers once and in order; one request at a time; nothing is left or broken."""
    assert [a.ResponseID for a in rig.got("ImpactAutomationResponse")] == list(range(asked))
    assert not rig.got("AutomationResponse")
    state = rig.bus.state(VALIDATOR)
    assert (state.asked, state.work) == ({}, 0)
    assert (state.line.taken, state.line.answered) == (asked, asked)
    # in the order in which it said it: what was held back comes later
    published = sorted((e for e in rig.all if e.source == VALIDATOR), key=lambda e: e.seq)
    out = 0
    for envelope in published:
        kind = envelope.topic.rpartition(".")[2]
        if kind == "UniqueAutomationRequest":
            assert out == 0, "one in the pipeline at a time"
            out = envelope.body.RequestID
        elif kind == "ImpactAutomationResponse":
            out = 0
    assert out == 0
    uniques = [e.body.RequestID for e in published if e.topic.endswith(".UniqueAutomationRequest")]
    assert uniques == sorted(set(uniques))
    assert not rig.said.has("fails at")
