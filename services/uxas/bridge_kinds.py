"""The bridge types of a configuration: attributes, limits, keys, and constructors.

Addresses default to UxAS's ports on 127.0.0.1; an address with `*` listens on all interfaces, and
this is logged.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cratous.bridge.port import FULL_POLICIES, Limits, Port
from cratous.services.loading.uxas_settings import (
    Attr,
    Entry,
    choice,
    flag,
    nearest,
    number,
    values_of,
    whole,
)
from cratous.services.uxas.bridge_entry import Children, Given
from cratous.services.uxas.bridges import Bridge
from cratous.services.uxas.zyre import zyre_bridge
from cratous.spec.errors import BadInput

ZMQ_SCHEMES = ("tcp", "ipc", "inproc", "udp")
_DEFAULT = Limits()
_SETTLE_S = 0.5  # longer than ZeroMQ's reconnection interval (100 to 200 ms)

LIMITS: Mapping[str, Attr] = {
    "MaxMessageSize_bytes": whole(_DEFAULT.payload_bytes, 1024, 2**30),
    "MaxWaiting_bytes": whole(_DEFAULT.waiting_bytes, 1024, 2**30),
    "WhenFull": choice(_DEFAULT.when_full, *FULL_POLICIES),
    "FrameTimeout_s": number(_DEFAULT.frame_s, 0.01),
    "MaxConnections": whole(_DEFAULT.connections, 1, 100_000),
    "HighWaterMark": whole(_DEFAULT.high_water, 1, 10**7),
}
KEYS: Mapping[str, Attr] = {
    "CurveSecretKeyFile": Attr(),
    "CurveServerKeyFile": Attr(),
    "CurveClientKeys": Attr(),
}
SUBSCRIBE = {"SubscribeToMessage": {"MessageType": Attr(needed=True)}}
EXTERNAL = {"SubscribeToExternalMessage": {"MessageType": Attr(needed=True)}}
TRANSFORM = {
    "TransformReceivedMessage": {"MessageType": Attr(needed=True), "Alias": Attr(needed=True)}
}


@dataclass(frozen=True)
class BridgeKind:
    """A bridge type: its attributes, its children with theirs, and its constructor."""

    attributes: Mapping[str, Attr]
    children: Mapping[str, Mapping[str, Attr]]
    make: Callable[[Given], Bridge]


def curve_of(values: Mapping[str, Any], where: str, config: Path, domain: str) -> Any:
    """The keys named by attributes, relative to the configuration's folder; None if there are none."""
    if not values["CurveSecretKeyFile"]:
        for name in ("CurveServerKeyFile", "CurveClientKeys"):
            if values[name]:
                raise BadInput(
                    "keys of other processes without a key pair of its own",
                    where=where,
                    item=name,
                    expected="CurveSecretKeyFile as well",
                )
        return None
    from cratous.bridge.zmq_curve import Curve

    paths = [
        config.parent / values[name] if values[name] else None
        for name in ("CurveSecretKeyFile", "CurveServerKeyFile", "CurveClientKeys")
    ]
    assert paths[0] is not None
    return Curve(paths[0], paths[1], paths[2], where=where, domain=domain)


def _tcp(given: Given) -> Bridge:
    from cratous.bridge.tcp_port import TcpPort

    v = given.values
    port = TcpPort(
        given.address("TcpAddress", ("tcp",)),
        server=v["Server"],
        limits=given.limits(),
        report=given.host.log,
    )
    aliases = {
        c["MessageType"]: c["Alias"] for c in given.children.get("TransformReceivedMessage", ())
    }
    return given.bridge(port, own_only=False, group="TcpBridge", aliases=aliases)


def _serial(given: Given) -> Bridge:
    from cratous.bridge.serial_port import SerialPort

    v = given.values
    port = SerialPort(
        v["SerialPortAddress"],
        v["BaudRate"],
        limits=given.limits(),
        report=given.host.log,
        where=given.entry.where,
    )
    return given.bridge(port, own_only=True, group="SerialBridge")


def _pair(given: Given, out: str, into: str, parts: int = 1) -> Port:
    """The sockets of a ZeroMQ bridge, or UDP if both addresses use it."""
    to = given.address(f"Address{out}", ZMQ_SCHEMES)
    at = given.address(f"Address{into}", ZMQ_SCHEMES)
    if "udp" in (to.scheme, at.scheme):
        from cratous.bridge.udp_port import UdpPort

        if to.scheme != at.scheme or parts > 1:
            raise BadInput(
                "UDP on one side only" if parts == 1 else "UDP has no messages of two parts",
                where=given.entry.where,
                item=f"Address{out}, Address{into}",
                expected="udp:// for both" if parts == 1 else "tcp://, ipc:// or inproc://",
                got=f"{to.text}, {at.text}",
            )
        return UdpPort(to, at, limits=given.limits(), report=given.host.log)
    from cratous.bridge.zmq_port import End, ZmqPort

    bind = out == "PUB"
    external = given.prefixes("SubscribeToExternalMessage")
    if into == "SUB":
        if parts == 1:
            external = (*external, f"eid{given.identity.entity_id}.")
        elif not external:
            given.host.log("WARN", f"{given.entry.where}: nothing external is subscribed to")
    curve = curve_of(given.values, given.entry.where, given.host.config, given.name)
    if curve is not None:
        given.host.shared["admit"](curve)
    return ZmqPort(
        given.context,
        End(out, to, bind),
        End(into, at, bind, external),
        parts=parts,
        limits=given.limits(),
        curve=curve,
        report=given.host.log,
        settle_s=_SETTLE_S if bind else 0.0,
    )


def _publish_pull(given: Given) -> Bridge:
    return given.bridge(
        _pair(given, "PUB", "PULL"), own_only=True, group="PublishPullBridge", relay=True
    )


def _subscribe_push(given: Given) -> Bridge:
    return given.bridge(
        _pair(given, "PUSH", "SUB"), own_only=True, group="SubscribePushBridge", returns=True
    )


def _impact(given: Given) -> Bridge:
    v, own = given.values, given.identity.entity_id
    foreign = own if v["ExternalID"] is None or v["ConsiderSelfGenerated"] else v["ExternalID"]
    return given.bridge(
        _pair(given, "PUSH", "SUB", parts=2),
        own_only=False,
        group="fusion",
        impact=True,
        external_id=foreign,
        throttle=v["ThrottleConfigurationForwarding"],
    )


def _zyre(given: Given) -> Bridge:
    return zyre_bridge(given)


def _kind(
    own: Mapping[str, Attr],
    children: Mapping[str, Mapping[str, Attr]],
    make: Callable[[Given], Bridge],
    self_generated: bool = False,
    keys: bool = False,
) -> BridgeKind:
    common = {"ConsiderSelfGenerated": flag(self_generated), "Trust": flag(False), **LIMITS}
    common |= KEYS if keys else {}
    return BridgeKind({**own, **common}, {**SUBSCRIBE, **children}, make)


def _addresses(publisher: str, pusher: str) -> dict[str, Attr]:
    """The attributes of a socket pair: the publisher's address and the pusher's."""
    return {
        f"Address{publisher}": Attr(default="tcp://127.0.0.1:5556"),
        f"Address{pusher}": Attr(default="tcp://127.0.0.1:5555"),
    }


BRIDGES: dict[str, BridgeKind] = {
    "LmcpObjectNetworkTcpBridge": _kind(
        {"TcpAddress": Attr(default="tcp://127.0.0.1:5555"), "Server": flag(False)},
        TRANSFORM,
        _tcp,
        self_generated=True,
    ),
    "LmcpObjectNetworkPublishPullBridge": _kind(
        _addresses("PUB", "PULL"),
        {},
        _publish_pull,
        keys=True,
    ),
    "LmcpObjectNetworkSubscribePushBridge": _kind(
        _addresses("SUB", "PUSH"),
        EXTERNAL,
        _subscribe_push,
        keys=True,
    ),
    "ImpactSubscribePushBridge": _kind(
        {
            **_addresses("SUB", "PUSH"),
            "ExternalID": whole(None),
            "ThrottleConfigurationForwarding": flag(False),
        },
        EXTERNAL,
        _impact,
        keys=True,
    ),
    "LmcpObjectNetworkSerialBridge": _kind(
        {"SerialPortAddress": Attr(needed=True), "BaudRate": whole(57600, 50, 4_000_000)},
        {},
        _serial,
        self_generated=True,
    ),
    "LmcpObjectNetworkZeroMqZyreBridge": _kind(
        {
            "NetworkDevice": Attr(default="lo"),
            "ZyreEndpoint": Attr(),
            "GossipEndpoint": Attr(),
            "GossipBind": flag(False),
            "BeaconPort": whole(5670, 1, 65535),
        },
        EXTERNAL,
        _zyre,
    ),
}


def check(
    entry: Entry, kind: BridgeKind, problems: list[BadInput]
) -> tuple[dict[str, Any], Children]:
    """Values and children of an entry; errors are added to `problems`."""
    values = values_of(kind.attributes, entry.attributes, entry.where, entry.type, problems)
    children: Children = {}
    for element in entry.children:
        where = entry.place(element)
        known = kind.children.get(element.tag)
        if known is None:
            problems.append(
                BadInput(
                    "unknown element",
                    where=where,
                    item=f"{entry.type}.<{element.tag}>",
                    expected=nearest(str(element.tag), kind.children),
                )
            )
            continue
        found = values_of(known, element.attrib, where, f"<{element.tag}>", problems)
        children.setdefault(element.tag, []).append(found)
    return values, children
