"""A validated bridge entry of a configuration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cratous.bridge.port import Address, Limits, Port, address
from cratous.services.bus import Identity
from cratous.services.loading.uxas_settings import Entry
from cratous.services.uxas.bridges import Bridge, Rules
from cratous.services.uxas.frame import Host

Children = dict[str, list[dict[str, Any]]]


@dataclass(frozen=True)
class Given:
    """A validated configuration entry: values, children by tag, and context."""

    host: Host
    entry: Entry
    values: dict[str, Any]
    children: Children
    identity: Identity
    name: str
    context: Any

    def prefixes(self, tag: str = "SubscribeToMessage") -> tuple[str, ...]:
        """The subscribed prefixes, without duplicates."""
        return tuple(dict.fromkeys(c["MessageType"] for c in self.children.get(tag, ())))

    def limits(self) -> Limits:
        """The limits that it sets."""
        v = self.values
        return Limits(
            payload_bytes=v["MaxMessageSize_bytes"],
            waiting_bytes=v["MaxWaiting_bytes"],
            when_full=v["WhenFull"],
            frame_s=v["FrameTimeout_s"],
            connections=v["MaxConnections"],
            high_water=v["HighWaterMark"],
        )

    def address(self, name: str, schemes: tuple[str, ...]) -> Address:
        """An attribute as an address; logs if `*` makes it listen on all interfaces."""
        found = address(self.values[name], schemes, where=self.entry.where, item=name, free=True)
        if found.everywhere:
            self.host.log(
                "WARN", f"{self.entry.where}: {name}={found.text} listens on all interfaces"
            )
        return found

    def bridge(self, port: Port, **rules: Any) -> Bridge:
        """A bridge with this port."""
        made = Rules(
            prefixes=self.prefixes(),
            self_generated=self.values["ConsiderSelfGenerated"],
            trusted=self.values["Trust"],
            **rules,
        )
        return Bridge(self.name, self.host, self.identity, port, made)
