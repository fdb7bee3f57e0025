"""The assumption that aircraft fly between two heartbeats as predicted at the first. Decided by the
kernels `disc_within` and `in_time`.

The prediction of an ICAROUS instance is not in the log. What can be observed is each aircraft's
deviation from straight flight: the prediction for other aircraft, and the first piece of the
vehicle's own path, wherever that leads on.
"""

from __future__ import annotations

import math

from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.avoidance.prediction import Piece, after
from cratous.core.permit.tubes import disc_within
from cratous.services.assumptions.link import NO_INSTANCE
from cratous.services.assumptions.motion import Positions, Seen, is_within, off_by, room_of
from cratous.services.assumptions.observations import Message, Record, gone_ms
from cratous.spec.mission import Mission


class AheadWatch:
    """Compares every aircraft with straight flight from one heartbeat to the next."""

    kinds = ("TruthState",)

    def __init__(self, mission: Mission, positions: Positions | None = None) -> None:
        """positions: shared with other watches of the same samples."""
        self._room = room_of(mission.daa)
        self._period_ms = mission.simulation.heartbeat_ms
        self._step_ms = mission.simulation.step_ms
        self._positions = positions or Positions()
        self._last_ms = {v.id: 0 for v in mission.vehicles}
        self._last_ms |= {t.id: t.appears_ms for t in mission.traffic}
        self._gone_ms = gone_ms(mission)
        self._base: dict[int, Seen] = {}
        none = "" if mission.instances else NO_INSTANCE
        kernels = (disc_within, in_time, lasted)
        self._record = Record("m", self._room.wide_m, kernels, none, waits="no aircraft was seen")

    def message(self, message: Message) -> None:
        """Process the true state of an aircraft."""
        if message.kind != "TruthState" or self._record.unseen:
            return
        number, here = message.body.VehicleID, self._positions.seen(message)
        last_ms = self._last_ms.get(number, here.time_ms)
        self._record.unseen_between(f"aircraft {number}", last_ms, here.time_ms, self._step_ms)
        self._last_ms[number] = here.time_ms
        base = self._base.setdefault(number, here)
        t_s = (here.time_ms - base.time_ms) / 1000
        off = off_by(here.position, after(Piece(0.0, t_s, base.position, base.velocity), t_s))
        beside_m = math.hypot(off.north_m, off.east_m)
        self._record.see(beside_m)
        if not is_within(off, self._room):
            text = (
                f"aircraft {number} is {beside_m:.4g} m beside and {abs(off.alt_m):.4g} m above or below where it "
                f"would be if it had flown straight on from {base.time_ms / 1000:.2f} s"
            )
            self._record.check(False, here.time_ms, number, text)
        if lasted(base.time_ms, here.time_ms, self._period_ms):
            self._base[number] = here

    def end(self, at_ms: int) -> None:
        """Check that every aircraft was observed until at_ms [ms], or until it disappeared."""
        for number, last_ms in self._last_ms.items():
            until_ms = max(last_ms, min(at_ms, self._gone_ms.get(number, at_ms)))
            self._record.unseen_between(f"aircraft {number}", last_ms, until_ms, self._step_ms)

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"flown as looked at": self._record}
