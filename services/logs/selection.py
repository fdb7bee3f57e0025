"""Selects messages of a log by type (including subtypes), time, entity and text.

An entity is named by any field of a message that holds entity ids (`EntityID`, `VehicleID`,
`EntityList`, ...), and by `ID` in entity states and configurations.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from difflib import get_close_matches
from fnmatch import fnmatchcase
from typing import Any

from cratous.services.logs.entry import Entry, any_data
from cratous.spec.errors import BadInput

_ENTITY_FIELD = re.compile(
    r"(?:\w*(?:Vehicle|Entity)(?:ID|Id|List|s)?|\w*Entities\w*|IntruderID|AffectedAircraft)\Z"
)
_ENTITIES = ("afrl.cmasi.EntityState", "afrl.cmasi.EntityConfiguration")


@dataclass
class Selection:
    """Which messages to keep; all by default.

    types: full, series or short names, each with its subtypes; `*` and `?` match topics as in file
    names. from_ms, to_ms: first and last time, both included [ms]. entities: ids, one of which must
    be named. text: contained in the JSON form, ignoring case. sources: names of senders.
    """

    types: tuple[str, ...] = ()
    from_ms: int | None = None
    to_ms: int | None = None
    entities: tuple[int, ...] = ()
    text: str = ""
    sources: tuple[str, ...] = ()
    _topics: dict[str, bool] = field(default_factory=dict, init=False, repr=False)
    _wanted: list[tuple[str, Callable[[str], bool]]] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._wanted = [(name, _topic_test(name)) for name in self.types]

    def __bool__(self) -> bool:
        kept = (self.from_ms, self.to_ms)
        return kept != (None, None) or bool(
            self.types or self.entities or self.text or self.sources
        )

    def wants_topic(self, topic: str) -> bool:
        """Whether messages of this type are kept."""
        found = self._topics.get(topic)
        if found is None:
            found = not self._wanted or any(test(topic) for _, test in self._wanted)
            self._topics[topic] = found
        return found

    def of(self, entries: Iterable[Entry]) -> Iterator[Entry]:
        """The messages that are kept."""
        return (entry for entry in entries if self.keeps(entry))

    def keeps(self, entry: Entry) -> bool:
        """Whether one message is kept."""
        if not self.wants_topic(entry.topic) or not self._in_time(entry.time_ms):
            return False
        if self.sources and entry.source not in self.sources:
            return False
        if not self.text and not self.entities:
            return True
        data, _ = any_data(entry)
        if self.text:
            shown = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
            if self.text.casefold() not in shown.casefold():
                return False
        return not self.entities or names_entity(data, entry.topic, frozenset(self.entities))

    def _in_time(self, time_ms: int) -> bool:
        early = self.from_ms is not None and time_ms < self.from_ms
        late = self.to_ms is not None and time_ms > self.to_ms
        return not (early or late)

    def sql(self) -> tuple[str, tuple[Any, ...]]:
        """An SQL condition that keeps at least these messages, with its parameters."""
        parts: list[str] = []
        values: list[Any] = []
        for text, limit in (("time_ms >= ?", self.from_ms), ("time_ms <= ?", self.to_ms)):
            if limit is not None:
                parts.append(text)
                values.append(limit)
        if self.sources:
            parts.append(f"source IN ({', '.join('?' * len(self.sources))})")
            values += self.sources
        return " AND ".join(parts), tuple(values)

    def check_types(self, topics: Iterable[str]) -> None:
        """BadInput for a selected type that is neither known nor among the topics of the log."""
        there = list(topics)
        for name, test in self._wanted:
            if not _known(name) and not any(test(topic) for topic in there):
                raise BadInput(
                    "unknown type, and the log has none of that name",
                    item=name,
                    expected=_nearest(name, there) or "a type's name, or a pattern: 'afrl.cmasi.*'",
                    got=", ".join(sorted(there)[:8]) or "an empty log",
                )


def _nearest(name: str, topics: list[str]) -> str:
    """Types with similar names, those of the log first."""
    from cratous.bridge import lmcp

    short = [full.rpartition(".")[2] for full in (*topics, *lmcp.types)]
    return " or ".join(get_close_matches(name.rpartition(".")[2], dict.fromkeys(short), 3))


def _known(name: str) -> bool:
    from cratous.bridge import lmcp

    return "*" not in name and "?" not in name and name in lmcp.types


def _topic_test(name: str) -> Callable[[str], bool]:
    if "*" in name or "?" in name:
        return lambda topic: fnmatchcase(topic, name)
    if not _known(name):
        return lambda topic: topic == name
    from cratous.bridge import lmcp

    full = lmcp.types[name].all_names[0]
    return lambda topic: topic == full or full in names_of(topic)


def names_of(topic: str) -> tuple[str, ...]:
    """The full names of a message type and of its base types; empty for a type without a model."""
    from cratous.bridge import lmcp

    return lmcp.types[topic].all_names if topic in lmcp.types else ()


def names_entity(data: Any, topic: str, ids: frozenset[int]) -> bool:
    """Whether a message in its JSON form names one of these entities."""
    bases = names_of(topic)
    own = any(base in bases for base in _ENTITIES)
    return _names(data, ids, own)


def _names(data: Any, ids: frozenset[int], own: bool) -> bool:
    if isinstance(data, list):
        return any(_names(part, ids, False) for part in data)
    if not isinstance(data, dict):
        return False
    for key, value in data.items():
        if (own and key == "ID") or _ENTITY_FIELD.match(key):
            found = value if isinstance(value, list) else [value]
            if any(type(one) is int and one in ids for one in found):
                return True
        if isinstance(value, (dict, list)) and _names(value, ids, False):
            return True
    return False
