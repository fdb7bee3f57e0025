"""Configuration of IcarousCommunicationService: the original's attributes, and ours."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from cratous.bridge.port import Address, address
from cratous.bridge.text_protocol.dialects import Dialect
from cratous.bridge.text_protocol.keys import Keys, keys_of
from cratous.core.authority.link_loss import FINISH
from cratous.services.icarous_communication.listeners import FORMS, Dialects, Door, form_of
from cratous.services.icarous_communication.unheard import (
    CHOICES,
    IN_HAND,
    LostLink,
)
from cratous.services.loading.lost_link_attributes import ATTRIBUTES as LOST_LINK
from cratous.services.loading.lost_link_attributes import lost_link_attributes
from cratous.services.loading.uxas_settings import Attr, Entry, choice, flag, number, whole
from cratous.spec.errors import BadInput

MOST_INSTANCES = 64
ATTRIBUTES: Mapping[str, Attr] = {
    "NumberOfUAVs": whole(None, 1, MOST_INSTANCES)._replace(needed=True),
    "RoutePlannerUsed": whole(-1, -1, 3),
    "DeviationAllowed": whole(None, 0),
    "DeviationOrigin": choice("line", "line", "path"),
    # ours: addresses, vehicles, time limits and dialects
    "Address": Attr(),
    "Connect": Attr(),
    "VehicleIDs": Attr(),
    "Timeout_s": number(60.0),
    "Dialect": choice("v2", *FORMS),
    "OtherDialects": Attr(),
    "Keys": Attr(),
    "PlainBeyondLoopback": flag(False),
    "RouteTimeout_s": number(2.0, 0.1, 600.0),
    "UseUxasRoutePlanner": flag(False),
    **LOST_LINK,
}
DEVIATION_M = 500.0
"""Deviation from its leg at which a vehicle's tasks are paused during avoidance [m]."""
FROM_LINE_M = 200.0
"""Subtracted where the configuration counts the deviation from the searched line, as the original does [m]."""


LISTENS_AT = "tcp://127.0.0.1:5557"
"""Default address for listening."""


class Settings(NamedTuple):
    """instances: number to wait for; deviation_m: see DEVIATION_M; where: address to listen at; to: addresses
    to connect to instead, one per instance; keys: of the vehicles, set for v2; ids: vehicles, () for the
    lowest known; wait_s: for the instances [s]; dialect: of the peers, also of the lines inside v2's
    packets; planner: RoutePlannerUsed, -1 for UxAS's own; answer_s: limit for a route [s]; live: ICAROUS
    may request a way back from UxAS during a takeover; others: addresses for other dialects; lost: what is
    flown while an instance is not heard.
    """

    instances: int
    deviation_m: float = DEVIATION_M
    where: Address = Address("tcp", "127.0.0.1", 5557, LISTENS_AT)
    ids: tuple[int, ...] = ()
    wait_s: float = 60.0
    dialect: Dialect = Dialect.CRATOUS
    to: tuple[Address, ...] = ()
    keys: Keys | None = None
    planner: int = -1
    answer_s: float = 2.0
    live: bool = False
    others: tuple[Door, ...] = ()
    lost: LostLink = IN_HAND

    @property
    def doors(self) -> tuple[Door, ...]:
        """Addresses at which instances connect, that of the usual dialect first."""
        elsewhere = {vid for door in self.others for vid in door.ids}
        own = tuple(vid for vid in self.ids if vid not in elsewhere)
        return (Door(self.where, self.dialect, own, self.keys), *self.others)

    @property
    def dialects(self) -> Dialects:
        """The dialects of all peers."""
        return Dialects(self.dialect, {vid: one.dialect for one in self.others for vid in one.ids})


def settings_of(entry: Entry, v: Mapping[str, Any]) -> Settings:
    """The settings of an entry; BadInput for values that cannot be honoured."""
    where = address(
        v["Address"] or LISTENS_AT,
        ("tcp",),
        where=entry.where,
        item=f"{entry.type}.Address",
        free=True,
    )
    count, allowed = v["NumberOfUAVs"], v["DeviationAllowed"]
    deviation_m = DEVIATION_M if allowed is None else float(allowed)
    if allowed is not None and v["DeviationOrigin"] == "line":
        deviation_m = max(0.0, deviation_m - FROM_LINE_M)
    ids = _ids(entry, v["VehicleIDs"], count)
    dialect = form_of(v["Dialect"])
    to = _to(entry, v["Connect"], count)
    if to and (v["Address"] or dialect is Dialect.ORIGINAL):
        raise BadInput(
            "Connect with what it excludes",
            where=entry.where,
            item=f"{entry.type}.Connect",
            expected="neither Address, where it would listen, nor the original's instances, which "
            "connect and do not listen",
            got=f'Address="{v["Address"]}" Dialect="{v["Dialect"]}"',
        )
    others = _others(entry, v, ids, where)
    own = tuple(vid for vid in ids if not any(vid in door.ids for door in others))
    keys = _keys(entry, v, own, to or (where,))
    live = v["UseUxasRoutePlanner"]
    if live and not dialect.ours:
        item, expected = (
            "UseUxasRoutePlanner",
            'Dialect="cratous" or "v2": others have no such line',
        )
        raise entry.refusal("peers that cannot ask UxAS", item, expected, dialect.value)
    routes = v["RoutePlannerUsed"], v["RouteTimeout_s"], live
    lost = _lost_link(entry, v)
    return Settings(
        count, deviation_m, where, ids, v["Timeout_s"], dialect, to, keys, *routes, others, lost
    )


_OTHER = re.compile(rf"(\d{{1,18}})=({'|'.join(FORMS)})@(tcp://\S+)")


def _others(
    entry: Entry, v: Mapping[str, Any], ids: tuple[int, ...], usual: Address
) -> tuple[Door, ...]:
    """The doors for OtherDialects, one per address."""
    text, item = v["OtherDialects"], "OtherDialects"
    found: dict[str, tuple[str, Address, list[int]]] = {}
    known = {(usual.host, usual.port)}
    left = set(ids)
    for word in text.split():
        match = _OTHER.fullmatch(word)
        form = (
            "ID=DIALECT@tcp://HOST:PORT for some of VehicleIDs, each once, not all, without Connect"
        )
        if match is None or int(match[1]) not in left or len(left) == 1 or v["Connect"]:
            raise entry.refusal("not a vehicle and its dialect", item, form, word[:80])
        left.discard(int(match[1]))
        where = address(
            match[3], ("tcp",), where=entry.where, item=f"{entry.type}.{item}", free=True
        )
        if match[3] not in found:
            if where.port and (where.host, where.port) in known:
                raise entry.refusal("one address twice", item, "another one", word[:80])
            known.add((where.host, where.port))
        dialect, _, vehicles = found.setdefault(match[3], (match[2], where, []))
        if dialect != match[2]:
            raise entry.refusal("two dialects at one address", item, dialect, word[:80])
        vehicles.append(int(match[1]))
    return tuple(_door(entry, v, *one) for one in found.values())


def _door(entry: Entry, v: Mapping[str, Any], form: str, where: Address, ids: list[int]) -> Door:
    own = tuple(sorted(ids))
    if form == "v2":
        keys = keys_of(own, Path(v["Keys"]) if v["Keys"] else None)
        return Door(where, form_of(form), own, keys)
    if not (where.loopback or v["PlainBeyondLoopback"]):
        expected = 'v2, an address of loopback, or PlainBeyondLoopback="true"'
        raise entry.refusal("no authentication", "OtherDialects", expected, f"{form}@{where.text}")
    return Door(where, form_of(form), own)


def _keys(
    entry: Entry, v: Mapping[str, Any], ids: tuple[int, ...], ends: tuple[Address, ...]
) -> Keys | None:
    """The keys of v2; a dialect without authentication is restricted to loopback unless configured otherwise."""
    if v["Dialect"] == "v2":
        if ids:
            return keys_of(ids, Path(v["Keys"]) if v["Keys"] else None)
        item = "VehicleIDs"
        expected = 'the vehicles whose keys v2 needs, or Dialect="cratous", "original" or "thesis"'
    elif v["Keys"] and "=v2@" not in v["OtherDialects"]:
        item, expected = "Keys", 'none, or Dialect="v2"'
    elif all(one.loopback for one in ends) or v["PlainBeyondLoopback"]:
        return None
    else:
        item, expected = "Dialect", 'v2, an address of loopback, or PlainBeyondLoopback="true"'
    got = f'Dialect="{v["Dialect"]}" VehicleIDs="{v["VehicleIDs"]}" Keys="{v["Keys"]}"'
    raise entry.refusal("no authentication", item, expected, got)


def _lost_link(entry: Entry, v: Mapping[str, Any]) -> LostLink:
    """What is flown while an instance is not heard."""
    asked, after_ms, to = lost_link_attributes(entry, v)
    choice = FINISH if asked is None else CHOICES[asked.value]
    return LostLink(choice, after_ms, asked is None, to)


def _to(entry: Entry, text: str, count: int) -> tuple[Address, ...]:
    item = f"{entry.type}.Connect"
    words = text.split()
    to = tuple(address(word, ("tcp",), where=entry.where, item=item) for word in words)
    if to and not len(to) == len({(one.host, one.port) for one in to}) == count:
        raise BadInput(
            "not the addresses of the instances",
            where=entry.where,
            item=item,
            expected=f"{count} different addresses, as NumberOfUAVs says",
            got=text[:80],
        )
    return to


def _ids(entry: Entry, text: str, count: int) -> tuple[int, ...]:
    words = text.replace(",", " ").split()
    ids = tuple(sorted({int(word) for word in words if word.isdigit() and len(word) < 19}))
    if words and (len(ids) != len(words) or len(ids) != count or 0 in ids):
        raise BadInput(
            "not the vehicles of the instances",
            where=entry.where,
            item=f"{entry.type}.VehicleIDs",
            expected=f"{count} different ids above 0, as NumberOfUAVs says",
            got=text[:80],
        )
    return ids
