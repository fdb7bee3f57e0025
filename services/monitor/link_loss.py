"""G5 where the mission says what is flown without the link: that it began in time, and that nothing else was flown.

By what each ICAROUS said of it (`LinkLossState`), held against the kernel `loss_step`: from the mode before the
one that it told must follow, whatever was permitted or ended. It begins within a heartbeat after the silence has
become too long; a connection that had ended for longer, and nothing said, is a violation.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from cratous.core.authority.link_loss import FINISH, LINKED, LOITER, RETURN, Loss, loss_step
from cratous.core.authority.timeliness import in_time
from cratous.core.kernel import qualified
from cratous.services.monitor.required_rows import alone_without_link_item
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission.link_loss import WithoutLink

NUMBERS = {
    WithoutLink.FINISH: FINISH,
    WithoutLink.LOITER: LOITER,
    WithoutLink.RETURN: RETURN,
}
LATEST_BEATS = 2
"""After so many heartbeats more the end of a connection has been noticed: one to notice it, one for the last line."""
EITHER = (False, True)
NO_LOSS = Loss(LINKED, 0)


@dataclass
class Told:
    """One vehicle: loss: as it said last; said: what it flew since when, in words; wrong: what it should not have said
    or done, with the time [ms]; down_ms: when its connection ended [ms], None while it stands; margin_ms: the least
    that was left as a mode began [ms]."""

    loss: Loss = NO_LOSS
    said: list[str] = field(default_factory=list)
    wrong: list[tuple[int, str]] = field(default_factory=list)
    down_ms: int | None = None
    margin_ms: int | None = None
    checks: int = 0


class LinkLossWatch:
    """What the vehicles with an ICAROUS instance flew without the link; nothing where the mission does not say."""

    def __init__(self, mission: Mission) -> None:
        self._asked, self._beat_ms = mission.link_loss, mission.simulation.heartbeat_ms
        there = mission.instances if self._asked is not None else ()
        self._told = {number: Told() for number in there}
        self._over = False

    def state(self, body: Any) -> None:
        """A vehicle says what it flies from now on."""
        told = self._told.get(body.VehicleID)
        if told is None or self._asked is None:
            return
        told.checks += 1
        now_ms, heard_ms, after_ms = body.Time, body.Heard, self._asked.after_ms
        mode, chosen = int(body.Mode), NUMBERS[self._asked.choice]
        if told.loss.mode == LINKED:
            left_ms = heard_ms + after_ms + self._beat_ms - now_ms
            told.margin_ms = left_ms if told.margin_ms is None else min(told.margin_ms, left_ms)
            if not in_time(heard_ms + after_ms, now_ms, self._beat_ms):
                text = f"began {(now_ms - heard_ms) / 1000:g} s after UxAS was last heard"
                told.wrong.append((now_ms, text))
        may = {
            loss_step(told.loss, chosen, heard_ms, now_ms, after_ms, way, end).loss.mode
            for way in EITHER
            for end in EITHER
        }
        if mode not in may or mode == told.loss.mode or int(body.Chosen) != chosen:
            was = body.Mode.name
            told.wrong.append((now_ms, f"{was} is not what follows then"))
        told.loss = Loss(mode, now_ms)
        told.said.append(f"{body.Mode.name} from {now_ms / 1000:.2f} s")

    def status(self, body: Any) -> None:
        """UxAS's end says that a connection stands or has ended."""
        told = self._told.get(body.VehicleID)
        if told is None:
            return
        if body.Alive:
            self._missed(told, body.Time)
            told.down_ms = None
        elif told.down_ms is None and body.Note.startswith("link lost"):
            told.down_ms = body.Time

    def end(self, body: Any) -> None:
        """The mission ended."""
        self._over = True
        for told in self._told.values():
            self._missed(told, body.Time)

    def _missed(self, told: Told, now_ms: int) -> None:
        """Whether a connection has been down for so long that something should have been said."""
        if told.down_ms is None or told.loss.mode != LINKED or self._asked is None:
            return
        bound_ms = self._asked.after_ms + LATEST_BEATS * self._beat_ms
        since = told.loss.since_ms
        # what ended after the connection did was said meanwhile
        if not in_time(max(told.down_ms, since), now_ms, bound_ms):
            text = f"the link was down since {told.down_ms / 1000:.2f} s, and it did nothing"
            told.wrong.append((now_ms, text))

    def verdicts(self) -> list[Verdict]:
        """One verdict a vehicle."""
        return [self._verdict(number, told) for number, told in sorted(self._told.items())]

    def _verdict(self, vehicle: int, told: Told) -> Verdict:
        outcome, note, at_ms = Outcome.HOLDS, ", ".join(told.said), None
        if told.wrong:
            outcome, (at_ms, text) = Outcome.VIOLATED, told.wrong[0]
            note = f"{text}; {note}" if note else text
        elif not self._over:
            outcome = Outcome.UNKNOWN
            note = f"{note}; the messages stop too early" if note else "the messages stop too early"
        elif not note:
            note = "it was never without the link for long enough"
        kernels = tuple(qualified(kernel) for kernel in (loss_step, in_time)) if told.checks else ()
        margin = None if told.margin_ms is None else told.margin_ms / 1000
        return Verdict(
            "G5", alone_without_link_item(vehicle), outcome, Kind.OBSERVED, note,
            time_ms=at_ms, vehicles=(vehicle,), margin=margin,
            unit="s" if margin is not None else "", checks=told.checks, kernels=kernels,
        )  # fmt: skip
