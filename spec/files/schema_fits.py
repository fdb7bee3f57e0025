"""Whether a value fits a JSON Schema, quickly; where it does not, `jsonschema` says in words what is wrong.

Only keywords that are listed here are decided (JSON Schema, draft 2020-12); a schema with another one, or a
reference out of itself, is left to `jsonschema` altogether. So the answer yes is sure, and no is a question.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sized
from typing import Any

Check = Callable[[Any], bool]
"""Whether a value is right."""

SAYS_NOTHING = frozenset({"$schema", "$id", "$defs", "title", "description", "default"})
"""Keywords that no value can depart from."""


class _Unknown(Exception):
    """A schema that is not decided here."""


def fits(schema: dict[str, Any]) -> Check:
    """A check that says yes of values that fit the schema for sure; never of others."""
    try:
        return _Reader(schema).check(schema)
    except _Unknown:
        return lambda value: False


class _Reader:
    """Makes the check of each part of one schema, once."""

    def __init__(self, root: dict[str, Any]) -> None:
        self._root = root
        self._named: dict[str, Check] = {}

    def check(self, schema: Any) -> Check:
        if schema is True or schema == {}:
            return lambda value: True
        if schema is False:
            return lambda value: False
        parts = []
        for keyword, said in schema.items():
            if keyword in SAYS_NOTHING or keyword in TOGETHER:
                continue
            if keyword in ONE:
                parts.append(ONE[keyword](said))
            elif keyword in OF_SCHEMAS:
                parts.append(OF_SCHEMAS[keyword](self, said))
            elif keyword == "$ref":
                parts.append(self._reference(said))
            else:
                raise _Unknown(keyword)
        if not MEMBERS.isdisjoint(schema):
            parts.append(self._members(schema))
        if not ENTRIES.isdisjoint(schema):
            parts.append(self._entries(schema))
        if not BRANCHES.isdisjoint(schema):
            parts.append(self._branches(schema))
        return _every(parts)

    def _reference(self, said: str) -> Check:
        if said not in self._named:
            top, folder, name = [*said.split("/", 2), "", ""][:3]
            parts = self._root.get(folder, {})
            if (top, folder) != ("#", "$defs") or name not in parts:
                raise _Unknown(said)
            # it may be made of itself
            self._named[said] = lambda value: self._named[said](value)
            self._named[said] = self.check(parts[name])
        return lambda value: self._named[said](value)

    def _members(self, schema: dict[str, Any]) -> Check:
        """What is said of the members of an object, by name, by pattern, and of all others."""
        known = {name: self.check(part) for name, part in schema.get("properties", {}).items()}
        alike = [
            (re.compile(pattern), self.check(part))
            for pattern, part in schema.get("patternProperties", {}).items()
        ]
        others = self.check(schema.get("additionalProperties", True))

        def check(value: Any) -> bool:
            if not isinstance(value, dict):
                return True
            for name, member in value.items():
                found = known.get(name)
                if found is not None and not found(member):
                    return False
                other = found is None
                for pattern, part in alike:
                    if pattern.search(name):
                        other = False
                        if not part(member):
                            return False
                if other and not others(member):
                    return False
            return True

        return check

    def _entries(self, schema: dict[str, Any]) -> Check:
        """What is said of the entries of an array, by place, and of all others."""
        first = [self.check(part) for part in schema.get("prefixItems", [])]
        rest = self.check(schema.get("items", True))

        def check(value: Any) -> bool:
            if not isinstance(value, list):
                return True
            placed = all(part(entry) for part, entry in zip(first, value, strict=False))
            return placed and all(map(rest, value[len(first) :]))

        return check

    def _branches(self, schema: dict[str, Any]) -> Check:
        if "if" not in schema:
            return lambda value: True
        asked = self.check(schema["if"])
        then, other = self.check(schema.get("then", True)), self.check(schema.get("else", True))
        return lambda value: then(value) if asked(value) else other(value)

    def _some(self, said: list[Any]) -> Check:
        parts = [self.check(part) for part in said]
        return lambda value: any(part(value) for part in parts)

    def _all(self, said: list[Any]) -> Check:
        return _every([self.check(part) for part in said])

    def _one(self, said: list[Any]) -> Check:
        parts = [self.check(part) for part in said]
        return lambda value: sum(part(value) for part in parts) == 1

    def _names(self, said: Any) -> Check:
        part = self.check(said)
        return lambda value: not isinstance(value, dict) or all(map(part, value))


def _every(parts: list[Check]) -> Check:
    if len(parts) == 1:
        return parts[0]
    return lambda value: all(part(value) for part in parts)


def is_number(value: Any) -> bool:
    """A number of JSON: an int or a float, no truth value."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_integer(value: Any) -> bool:
    return is_number(value) and (isinstance(value, int) or value.is_integer())


KINDS: dict[str, Check] = {
    "object": lambda value: isinstance(value, dict),
    "array": lambda value: isinstance(value, list),
    "string": lambda value: isinstance(value, str),
    "boolean": lambda value: isinstance(value, bool),
    "null": lambda value: value is None,
    "number": is_number,
    "integer": _is_integer,
}


def _type(said: Any) -> Check:
    kinds = [KINDS[name] for name in ([said] if isinstance(said, str) else said)]
    return kinds[0] if len(kinds) == 1 else lambda value: any(kind(value) for kind in kinds)


def _is(said: Any) -> Check:
    if isinstance(said, (dict, list)):
        raise _Unknown("a constant with parts")
    # JSON's true is not 1, as Python's is
    return lambda value: isinstance(value, bool) == isinstance(said, bool) and value == said


def _is_one_of(said: list[Any]) -> Check:
    parts = [_is(one) for one in said]
    return lambda value: any(part(value) for part in parts)


def _required(said: list[str]) -> Check:
    return lambda value: not isinstance(value, dict) or all(name in value for name in said)


def _pattern(said: str) -> Check:
    found = re.compile(said).search
    return lambda value: not isinstance(value, str) or found(value) is not None


def _limit(kind: type[Sized], low: float, high: float) -> Check:
    return lambda value: not isinstance(value, kind) or low <= len(value) <= high


ONE: dict[str, Callable[[Any], Check]] = {
    "type": _type,
    "const": _is,
    "enum": _is_one_of,
    "required": _required,
    "pattern": _pattern,
    # not that it is less: of what is no number at all, NaN, nothing is
    "minimum": lambda low: lambda value: not is_number(value) or not value < low,
    "maximum": lambda high: lambda value: not is_number(value) or not value > high,
    "exclusiveMinimum": lambda low: lambda value: not is_number(value) or not value <= low,
    "exclusiveMaximum": lambda high: lambda value: not is_number(value) or not value >= high,
    "minLength": lambda low: _limit(str, low, math.inf),
    "maxLength": lambda high: _limit(str, 0, high),
    "minItems": lambda low: _limit(list, low, math.inf),
    "maxItems": lambda high: _limit(list, 0, high),
    "minProperties": lambda low: _limit(dict, low, math.inf),
    "maxProperties": lambda high: _limit(dict, 0, high),
}
"""Keywords that say something alone, of a value as a whole."""

OF_SCHEMAS: dict[str, Callable[[Any, Any], Check]] = {
    "anyOf": _Reader._some,
    "allOf": _Reader._all,
    "oneOf": _Reader._one,
    "propertyNames": _Reader._names,
}
"""Keywords with schemas that say something alone."""

MEMBERS = frozenset({"properties", "patternProperties", "additionalProperties"})
ENTRIES = frozenset({"prefixItems", "items"})
BRANCHES = frozenset({"if", "then", "else"})
TOGETHER = MEMBERS | ENTRIES | BRANCHES
"""Keywords whose meaning depends on one another."""
