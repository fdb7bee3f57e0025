"""Model of the certificate in hand of one vehicle: kernels check each change in the log.

The trajectory of an offer is not in the log, so whether it was permitted is not checked; whether it
may replace the certificate in hand, and the effects of news, expiry and handback, are.
"""

from __future__ import annotations

from typing import Any

from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.permit.hand import KNOWN, LEFT, OFFERED, Offer, accepts, hand_passed, hand_step
from cratous.services.flight.holding import BEATS, NO_OFFER, RESERVE_BEATS
from cratous.services.icarous.messages import EMPTY
from cratous.services.system_model.finding import Misfit

SAYS = ("Base", "BaseExpiry", "ID", "Knowledge", "Expiry", "Surprises")


class HandModel:
    """hand: the certificate in hand; certificate: whether it has a trajectory; heard_ms: time of
    ICAROUS's last command [ms].
    """

    def __init__(self, heartbeat_ms: int) -> None:
        self.hand = EMPTY
        self.certificate = False
        self.heard_ms = 0
        self._heartbeat_ms = heartbeat_ms

    @property
    def reserve_ms(self) -> int:
        """Time that an offer must leave certain [ms]."""
        return RESERVE_BEATS * self._heartbeat_ms

    def changes(self, body: Any, icarous_has_it: bool, now_ms: int) -> None:
        """Process a `HandState`; Misfit if it is not the kernels' result for the certificate in hand."""
        kind, before = body.Change.name, self.hand
        what = f"what is in hand ({kind})"
        if kind in ("Offered", "Refused"):
            offer = Offer(body.ID, body.Base, body.Sigma, body.Knowledge, body.Expiry)
            taken = accepts(hand_passed(before, now_ms), offer, now_ms, self.reserve_ms)
            if not in_time(body.Sigma, now_ms, 0):
                raise Misfit(what, f"one that begins now, at {now_ms} ms", f"{body.Sigma} ms")
            if not icarous_has_it or taken != (kind == "Offered"):
                expected = (
                    "one that may take the place of the hand" if taken else "one that may not"
                )
                raise Misfit(what, expected if icarous_has_it else "none under UxAS", str(offer))
            self.hand = hand_step(before, OFFERED, offer, False, now_ms, self.reserve_ms)
            self.certificate = self.certificate or taken
            said = (body.BaseExpiry, body.Surprises)
            self._same(what, said, (before.expiry_ms, self.hand.surprises))
            return
        if kind in ("Known", "Left"):
            event = KNOWN if kind == "Known" else LEFT
            if not self.certificate:
                raise Misfit(what, "a certificate that is in hand", "none")
            until_ms = body.Expiry if body.Permitted else before.expiry_ms
            asked = Offer(body.ID, body.Base, now_ms, body.Knowledge, until_ms)
            permitted = body.Permitted
            self.hand = hand_step(before, event, asked, permitted, now_ms, self.reserve_ms)
            self.certificate = kind == "Known"
        elif kind in ("Flown", "Expired"):
            silent = not in_time(self.heard_ms, now_ms, BEATS * self._heartbeat_ms)
            over = kind == "Flown" or lasted(before.expiry_ms, now_ms, 0)
            if not (icarous_has_it and silent and self.certificate and over):
                expected = "ICAROUS silent for more than two heartbeats, and a certificate"
                raise Misfit(what, expected, f"last commanded at {self.heard_ms} ms")
        after = self.hand
        meant = (before.id, before.expiry_ms, after.id, after.knowledge, after.expiry_ms)
        self._same(what, tuple(getattr(body, n) for n in SAYS), (*meant, after.surprises))

    def commands(self, now_ms: int) -> None:
        """Process a command or takeover by ICAROUS."""
        self.heard_ms = now_ms

    def leaves(self, now_ms: int) -> None:
        """Process a handback: with a certificate in hand, its `HandState` follows; without one, nothing is reported."""
        if not self.certificate:
            self.hand = hand_step(self.hand, LEFT, NO_OFFER, False, now_ms, self.reserve_ms)

    def handed_back(self, got: str) -> None:
        """Misfit if UxAS has the vehicle and the certificate is still in hand."""
        if self.certificate:
            raise Misfit("what is in hand", "that it is left, since UxAS has the vehicle", got)

    def _same(self, what: str, said: tuple[int, ...], meant: tuple[int, ...]) -> None:
        if said != meant:
            raise Misfit(what, str(meant), str(said))
