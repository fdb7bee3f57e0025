"""The Zyre bridge: sends messages to each peer whose subscriptions they match, as UxAS does.

A peer lists the address prefixes that it wants in its header `SubscribeToMessage` (separated by
`;`); matching messages are whispered to it once, as a sentinel frame. A peer without `EntityID`, or
with ours, is no peer of the bus. Joining and leaving are published on the bus: EntityJoin,
EntityExit.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.bridge import lmcp, sentinel
from cratous.bridge.port import Incoming
from cratous.bridge.zre import Beacons, ZreNode
from cratous.bridge.zre_peer import Event
from cratous.services.bus import Envelope
from cratous.services.uxas.bridge_entry import Given
from cratous.services.uxas.bridges import Bridge, Rules, number, pack
from cratous.spec.errors import BadInput


class ZyreBridge(Bridge):
    """A bridge whose port is a ZRE node."""

    node: ZreNode

    def __init__(self, given: Given, node: ZreNode, rules: Rules) -> None:
        super().__init__(given.name, given.host, given.identity, node, rules)  # type: ignore[arg-type]
        self.node = node
        self.prefixes = ("",)  # the peers' subscriptions select what goes out
        self._wanted: dict[str, tuple[str, ...]] = {}
        self._entities: dict[str, int] = {}

    @property
    def entities(self) -> tuple[int, ...]:
        """The entities that have joined."""
        return tuple(self._entities.values())

    def handle(self, state: None, envelope: Envelope, now_ms: int) -> tuple[None, Iterable[Any]]:
        """Whisper a message to every peer that subscribes to it."""
        if not self.exports(envelope):
            return None, ()
        to = envelope.to
        peers = [uuid for uuid, wanted in self._wanted.items() if to.startswith(wanted)]
        if peers:
            try:
                frame = sentinel.frame(pack(envelope))
            except BadInput as error:
                self._tally.lose("message has no form on the wire", str(error))
                return None, ()
            for uuid in peers:
                self.node.whisper(uuid, (frame,))
        return None, ()

    def pump(self, now_s: float) -> int:
        """Process the peers' events."""
        count = 0
        for event in self.node.step(now_s):
            try:
                count += self._event(event)
            except BadInput as error:
                self._tally.refuse(error.what, f"{event.name}: {error}")
        return count

    def _event(self, event: Event) -> int:
        bus = self._host.bus
        if event.kind == "ENTER":
            entity = self._entity(event)
            header = event.headers.get("SubscribeToMessage", "")
            self._wanted[event.peer] = tuple(part for part in header.split(";") if part)
            self._entities[event.peer] = entity
            label = event.headers.get("EntityType", "")
            bus.publish(lmcp.new("EntityJoin", EntityID=entity, Label=label), self.name)
            self._host.log("INFO", f"{self.name}: entity {entity} has joined ({event.address})")
        elif event.kind == "EXIT" and event.peer in self._entities:
            self._wanted.pop(event.peer, None)
            entity = self._entities.pop(event.peer)
            bus.publish(lmcp.new("EntityExit", EntityID=entity), self.name)
            self._host.log("INFO", f"{self.name}: entity {entity} has left")
        elif event.kind == "WHISPER" and event.peer in self._entities:
            for part in event.content:
                self._host.arrived(self._import(Incoming((sentinel.unframe(part),), event.name)))
            return len(event.content)
        return 0

    def _entity(self, event: Event) -> int:
        text = event.headers.get("EntityID", "")
        entity = number(text)
        if not text or entity == self._identity.entity_id:
            raise BadInput(
                "peer is no other entity",
                item="EntityID",
                expected=f"a number other than {self._identity.entity_id}",
                got=text or "none",
            )
        return entity


def zyre_bridge(given: Given) -> ZyreBridge:
    """The bridge of a configuration's entry; discovery is by beacons, not by gossip."""
    v, host = given.values, given.host
    for name in ("ZyreEndpoint", "GossipEndpoint"):
        if v[name]:
            raise BadInput(
                "discovery by gossip is not covered; peers are found by UDP beacons",
                where=given.entry.where,
                item=name,
                expected="NetworkDevice alone",
                got=v[name],
            )
    wanted = [*given.prefixes("SubscribeToExternalMessage"), f"eid{host.entity_id}"]
    headers = {
        "EntityID": str(host.entity_id),
        "EntityType": host.entity_type,
        "SubscribeToMessage": ";".join(dict.fromkeys(wanted)),
    }
    node = ZreNode(
        given.context,
        str(host.entity_id),
        headers=headers,
        beacons=Beacons(v["NetworkDevice"], v["BeaconPort"]),
        limits=given.limits(),
        report=host.log,
        where=given.entry.where,
    )
    rules = Rules(
        (),
        own_only=True,
        group="ZyreBridge",
        self_generated=v["ConsiderSelfGenerated"],
        trusted=v["Trust"],
    )
    return ZyreBridge(given, node, rules)
