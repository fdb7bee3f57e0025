"""Common behaviour of LMCP objects and enums: equality by value, copies, checks, a short repr.

The classes themselves are made in `lmcp.objects`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from enum import IntEnum
from typing import Any, ClassVar, TypeVar

from cratous.bridge.lmcp import model
from cratous.spec.errors import BadInput

Self = TypeVar("Self", bound="LmcpObject")
Check = Callable[[Any], Any]


class LmcpEnum(IntEnum):
    """Base of the enums: an int that prints by its name."""

    def __repr__(self) -> str:
        return self.name

    __str__ = __repr__


class LmcpObject:
    """Base of every message and of every object within a message."""

    __slots__ = ("_raw",)
    _raw: tuple[
        bytes, str
    ]  # only of the lazy classes of `lmcp.lazy_messages`: the message and its source
    series: ClassVar[str] = ""
    type_name: ClassVar[str] = ""  # as in `CMASI/AirVehicleState`
    type_id: ClassVar[int] = 0
    all_names: ClassVar[tuple[str, ...]] = ()  # full names: its own, then those of its bases
    fields: ClassVar[tuple[model.Field, ...]] = ()  # oldest ancestor first: the order on the wire
    names: ClassVar[tuple[str, ...]] = ()
    values_of: ClassVar[Any] = staticmethod(lambda _obj: ())  # all values, in that order
    _makers: ClassVar[tuple[tuple[str, Callable[[], Any] | None, Any], ...]] = ()
    _checks: ClassVar[dict[str, Check]] = {}
    _restore: ClassVar[Any] = None  # `objects.again`: it knows the classes by their names

    def __init__(self, **given: Any) -> None:
        if len(given) < len(self._makers):  # otherwise all are given, or an unknown one
            for name, make, constant in self._makers:
                if name not in given:
                    setattr(self, name, constant if make is None else make())
        self._set(given)

    def _set(self, given: dict[str, Any]) -> None:
        """Set fields by name, each value checked; BadInput with the nearest names for an unknown one."""
        checks, name = self._checks, ""
        try:
            for name, value in given.items():
                setattr(self, name, checks[name](value))
        except BadInput as err:
            raise within(err, f"{type(self).__name__}.{name}") from None
        except KeyError:
            if name in checks:
                raise
            raise unknown_field(type(self), name) from None

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return bool(self.values_of(self) == self.values_of(other))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Only the fields that differ from the default, so that long messages stay readable."""
        plain = type(self)()
        shown = [
            f"{name}={getattr(self, name)!r}"
            for name in self.names
            if getattr(self, name) != getattr(plain, name)
        ]
        return f"{type(self).__name__}({', '.join(shown)})"

    def __rich_repr__(self) -> Iterator[tuple[str, Any, Any]]:
        """The representation for `rich`, over several lines where it is long."""
        plain = type(self)()
        for name in self.names:
            yield name, getattr(self, name), getattr(plain, name)

    def __reduce__(self) -> tuple[Any, ...]:
        return self._restore, (self.type_name, self.values_of(self))

    def raw_message(self) -> bytes | None:
        """The bytes of the whole message, if it was read lazily and no field was read yet; else None."""
        return None

    def complete(self: Self) -> Self:
        """The object itself; if it was read lazily, all fields are read now."""
        return self

    def copy(self: Self, **changes: Any) -> Self:
        """A deep copy, with some fields changed; only the changed fields are checked."""
        kept = [(n, _copied(getattr(self, n))) for n in self.names if n not in changes]
        made = object.__new__(type(self))
        for name, value in kept:
            setattr(made, name, value)
        made._set(changes)
        return made

    def checked(self: Self, where: str = "") -> Self:
        """The object itself, after all its values are checked (or converted) to their types; else BadInput."""
        for name, check in self._checks.items():
            try:
                value = check(getattr(self, name))
                for i, part in enumerate(value if type(value) is list else (value,)):
                    if isinstance(part, LmcpObject):
                        part.checked(f"[{i}]" if type(value) is list else "")
            except BadInput as err:
                raise within(err, f"{where}{type(self).__name__}.{name}") from None
            setattr(self, name, value)
        return self


def within(err: BadInput, item: str) -> BadInput:
    """The same error, with `item` prepended to the path of the affected part."""
    path = item if not err.item else f"{item}{'' if err.item[0] == '[' else '.'}{err.item}"
    return BadInput(err.what, where=err.where, item=path, expected=err.expected, got=err.got)


def unknown_field(cls: type[LmcpObject], name: str, where: str = "") -> BadInput:
    """The error for a field that a class does not have, with the nearest names that it does have."""
    from difflib import get_close_matches

    by_lower = {n.lower(): n for n in cls.names}
    near = [by_lower[n] for n in get_close_matches(name.lower(), by_lower, 3)]
    if not near:
        near = list(cls.names) if len(cls.names) <= 8 else [f"one of its {len(cls.names)} fields"]
    return BadInput(
        "unknown field",
        where=where,
        item=f"{cls.__name__}.{name}",
        expected=" or ".join(near) or "no field at all",
        got=name,
    )


def _copied(value: Any) -> Any:
    if isinstance(value, LmcpObject):
        return value.copy()
    return [_copied(v) for v in value] if type(value) is list else value
