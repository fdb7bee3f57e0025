"""Bridges: an external port as a service of the bus, with UxAS's forwarding rules.

Out: messages whose address begins with a subscribed prefix; for a bridge type that keeps foreign
messages in (`own_only`), only those of our own entity; never its own imports (but see `relay`),
never messages addressed to the bridge itself, never KillService. In: LMCP that decodes; source
attributes as received, or those of the bridge if it treats messages as self-generated; no
CreateNewService or KillService, unless the configuration trusts the peers. What is dropped for any
other reason is counted and logged.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp
from cratous.bridge.port import Incoming, Port, Tally, often
from cratous.services.bus import Envelope, Identity, unicast
from cratous.services.uxas.frame import Host
from cratous.spec.errors import BadInput

KILL = "uxas.messages.uxnative.KillService"
CREATE = "uxas.messages.uxnative.CreateNewService"
_NAME_BYTES = 256  # maximum size of an address or group received from outside


@dataclass(frozen=True)
class Rules:
    """What a bridge type forwards, and how it names the source of imports.

    own_only: only our entity's messages go out. group: source group of imports treated as
    self-generated. self_generated: whether they are. aliases: new addresses of imports. impact: two
    parts, IMPACT's address and LMCP bytes, from entity `external_id`; throttle: send an identical
    AirVehicleConfiguration only once. relay: messages from clients in our entity's name are sent
    out again, so that all clients receive them. returns: such a relay returns our own messages,
    which are dropped. trusted: peers may create and end services.
    """

    prefixes: tuple[str, ...]
    own_only: bool
    group: str
    self_generated: bool
    aliases: dict[str, str] = field(default_factory=dict)
    impact: bool = False
    external_id: int = 0
    throttle: bool = False
    relay: bool = False
    returns: bool = False
    trusted: bool = False


class Bridge:
    """A port on the bus; the runtime calls `pump` when the port has input."""

    subscribes: tuple[str, ...] = ()
    outlet = True

    def __init__(self, name: str, host: Host, identity: Identity, port: Port, rules: Rules) -> None:
        self.name, self.port, self.rules = name, port, rules
        self.prefixes = tuple(p for p in rules.prefixes if p)
        self._host, self._identity = host, identity
        self._tally = Tally(name, host.log)
        self._tally.counts = port.counts
        self._sent_configurations: dict[int, Any] = {}
        self._notes: Counter[str] = Counter()
        self.on_closed: Callable[[], None] = lambda: None

    def start(self) -> None:
        return None

    def handle(self, state: None, envelope: Envelope, now_ms: int) -> tuple[None, Iterable[Any]]:
        """Send a message out if the rules permit."""
        if self.exports(envelope):
            try:
                parts = self._parts(envelope)
            except BadInput as error:
                self._tally.lose("message has no form on the wire", str(error))
                return None, ()
            self.port.send(parts)
        return None, ()

    def stop(self, state: None) -> None:
        """Close the port and log its statistics."""
        self.port.close()
        self._host.log("INFO", f"{self.name}: closed; {self.port.counts.line()}")
        self.on_closed()

    def exports(self, envelope: Envelope) -> bool:
        """True if the rules permit sending a message out."""
        mine = unicast(self._identity.entity_id, self._identity.service_id)
        if envelope.topic == KILL or envelope.to == mine:
            return False
        source = (envelope.entity_id, envelope.service_id)
        if envelope.source == self.name or source == self._identity[:2]:
            return False
        if self.rules.own_only and envelope.entity_id != self._identity.entity_id:
            return False
        return not (self.rules.throttle and self._known(envelope.body))

    def pump(self, now_s: float) -> int:
        """Put received messages on the bus; returns their number."""
        count = 0
        for incoming in self.port.step(now_s):
            try:
                self._host.arrived(self._import(incoming))
                count += 1
            except BadInput as error:
                self._tally.refuse(error.what, f"{incoming.peer}: {error}")
        return count

    def _known(self, body: Any) -> bool:
        if type(body).__name__ != "AirVehicleConfiguration":
            return False
        same = self._sent_configurations.get(body.ID) == body
        self._sent_configurations[body.ID] = body
        return same

    def _parts(self, envelope: Envelope) -> tuple[bytes, ...]:
        payload = envelope.packed
        if self.rules.impact:
            series, name = envelope.body.type_name.split("/")
            return f"lmcp:{series.upper()}:{name}".encode(), payload
        return (pack(envelope, payload),)

    def _import(self, incoming: Incoming) -> Envelope:
        if self.rules.impact:
            body, payload = self._received(incoming.parts[1], "message")
            self._admit(body)
            who = Identity(self.rules.external_id, self._identity.service_id, "fusion")
            return self._envelope(body, payload, "", who)
        message = wire.parse(incoming.parts[0])
        check(message)
        found, payload = self._received(message.payload, message.descriptor or message.address)
        who = Identity(number(message.entity_id), number(message.service_id), message.group)
        if self.rules.self_generated:
            who = self._identity._replace(group=self.rules.group)
        topic = self._admit(found)
        address = self.rules.aliases.get(message.address, message.address)
        if address != topic and address in lmcp.types:
            raise BadInput("payload of another type", item=address, expected=address, got=topic)
        if address == unicast(self._identity.entity_id, self._identity.service_id):
            raise BadInput("addressed to the bridge itself", got=address)
        if self.rules.returns and self._ours(who):
            raise BadInput("message of our own that came back", got=f"service {who.service_id}")
        source = self.name
        own = self._identity
        if self.rules.relay and who.entity_id == own.entity_id and who[:2] != own[:2]:
            # under another name it returns to this bridge, in the order of the bus
            source = f"eid{who.entity_id}.sid{who.service_id}"
        return self._envelope(found, payload, "" if address == topic else address, who, source)

    def _admit(self, body: Any) -> str:
        """The type of an object that may come in; BadInput for one permitted only from trusted peers."""
        topic: str = body.all_names[0]
        if topic in (KILL, CREATE) and not self.rules.trusted:
            raise BadInput(
                f"{topic.rpartition('.')[2]} over a bridge that is not trusted",
                expected='Trust="TRUE" on the bridge in the configuration',
            )
        return topic

    def _received(self, payload: bytes, where: str) -> tuple[Any, bytes]:
        """Object and message of a payload; a client's protocol deviations are reported."""
        body, payload, notes = lmcp.binary.received(payload, where)
        for note in notes:
            self._notes[note] += 1
            if often(self._notes[note]):
                count = f" ({self._notes[note]} times so far)" if self._notes[note] > 1 else ""
                self._host.log("INFO", f"{self.name}: let pass: {where}: {note}{count}")
        return body, payload

    def _ours(self, who: Identity) -> bool:
        if who.entity_id != self._identity.entity_id:
            return False
        bus = self._host.bus
        return any(bus.identity(name)[:2] == who[:2] for name in bus.names())

    def _envelope(
        self, body: Any, raw: bytes, address: str, who: Identity, source: str = ""
    ) -> Envelope:
        topic = body.all_names[0]
        now = self._host.bus.now_ms
        source = source or self.name
        return Envelope(0, now, source, topic, body, address, who.group, *who[:2], raw)


def pack(envelope: Envelope, payload: bytes | None = None) -> bytes:
    """A message of the bus as the bytes of one frame."""
    if payload is None:
        payload = envelope.packed
    return wire.enclose(
        envelope.topic,
        payload,
        group=envelope.group,
        entity_id=envelope.entity_id,
        service_id=envelope.service_id,
        address=envelope.address,
    ).pack()


def check(message: wire.AddressedMessage) -> None:
    """BadInput for a message that is not LMCP, or whose names are too long."""
    if message.content_type != wire.LMCP:
        raise BadInput(
            "unknown content type", item="contentType", expected="lmcp", got=message.content_type
        )
    if len(message.address) > _NAME_BYTES or len(message.group) > _NAME_BYTES:
        raise BadInput("name too long", item="address or group", expected=f"{_NAME_BYTES} bytes")


def unpack(message: wire.AddressedMessage) -> Any:
    """The LMCP object of a message; BadInput if there is none or a name is too long."""
    check(message)
    return lmcp.binary.unpack(message.payload, message.descriptor or message.address)


def number(text: str) -> int:
    """An id on the wire; empty means 0, as AMASE sends it."""
    if not text:
        return 0
    if not text.isascii() or not text.isdigit() or len(text) > 19:
        raise BadInput("not an id", item="sourceEntityId, sourceServiceId", got=text[:40])
    return int(text)
