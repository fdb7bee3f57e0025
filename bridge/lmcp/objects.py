"""LMCP objects: a real Python class for each struct, made from its model on first use.

Classes inherit as the structs do, so `isinstance(task, lmcp.types["afrl.cmasi.Task"])` works. Fields are slots;
numbers are int or float, enums IntEnum members, arrays lists, structs objects or None. The constructor takes fields
by name, checks them and refuses unknown names; later assignments are not checked until the object is written out. An
object that has been published on the bus must not be changed: copy it first.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from operator import attrgetter, index
from typing import Any

from cratous.bridge.lmcp import describe, model
from cratous.bridge.lmcp.base import Check, LmcpEnum, LmcpObject, unknown_field, within
from cratous.spec.errors import BadInput


def _wrong(expected: str, got: Any) -> BadInput:
    return BadInput("wrong value", expected=expected, got=repr(got)[:80])


def real(value: Any) -> float:
    """A number as float; bool, text and other types are refused."""
    if type(value) is float:
        return value
    if isinstance(value, (bool, str, bytes)) or not hasattr(value, "__float__"):
        raise _wrong("a number", value)
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise _wrong("a number", value) from None


def real32(value: Any) -> float:
    """A number that fits 32 bits; kept as given, rounded to 32 bits only on the wire."""
    if type(value) is float and -3.4e38 < value < 3.4e38:
        return value
    number = real(value)
    # Half a unit above the largest real32, where rounding to nearest would overflow.
    if abs(number) >= 3.4028235677973366e38 and not math.isinf(number):
        raise _wrong("a number within real32", value)
    return number


def _integer(kind: str) -> Check:
    low, high = model.INTEGER_RANGES[kind]

    def check(value: Any) -> int:
        if type(value) is int and low <= value <= high:
            return value
        try:
            number = index(value)
        except TypeError:
            raise _wrong(kind, value) from None
        if isinstance(value, bool) or not low <= number <= high:
            raise _wrong(f"{kind} from {low} to {high}", value)
        return int(number)

    return check


def _boolean(value: Any) -> bool:
    if type(value) is not bool:
        if type(value).__name__ in ("bool_", "bool"):  # numpy's own types
            return bool(value)
        raise _wrong("true or false", value)
    return value


def _text(value: Any) -> str:
    if type(value) is str:
        return value
    if not isinstance(value, str):
        raise _wrong("text", value)
    return str(value)


def _char(value: Any) -> str:
    if not isinstance(value, str) or len(value) != 1 or ord(value) > 255:
        raise _wrong("one character", value)
    return value


def _enum(type_name: str) -> Check:
    members: Any = None  # classes are made on first use

    def check(value: Any) -> LmcpEnum:
        nonlocal members
        if members is None:
            members = enums[type_name]
        if type(value) is members:
            return value
        if isinstance(value, str) and value in members.__members__:
            return members[value]
        if type(value) is int:
            try:
                return members(value)
            except ValueError:
                pass
        raise _wrong(f"{members.__name__}: {' or '.join(members.__members__)}", value)

    return check


def _object(type_name: str, nullable: bool) -> Check:
    base: Any = LmcpObject if type_name == model.ANY else None  # classes are made on first use

    def check(value: Any) -> LmcpObject | None:
        nonlocal base
        if value is None and nullable:
            return None
        if base is None:
            base = types[type_name]
        if not isinstance(value, base):
            raise _wrong(base.__name__ + (" or null" if nullable else ""), value)
        return value

    return check


def _array(field: model.Field, one: Check) -> Check:
    def check(value: Any) -> list[Any]:
        if isinstance(value, (str, bytes)) or not hasattr(value, "__iter__"):
            raise _wrong("a list", value)
        result: list[Any] = []
        try:
            for element in value:
                result.append(one(element))
        except BadInput as err:
            raise within(err, f"[{len(result)}]") from None
        if field.array and len(result) != field.array:
            raise _wrong(f"{field.array} elements", value)
        return result

    return check


_PRIMITIVES: dict[str, tuple[Check, Any]] = {
    "real32": (real32, 0.0),
    "real64": (real, 0.0),
    "bool": (_boolean, False),
    "string": (_text, ""),
    "char": (_char, "\0"),
    **{kind: (_integer(kind), 0) for kind in model.INTEGER_RANGES},
}


def element_check(field: model.Field) -> Check:
    """The check of one value, or one element of the array."""
    if field.kind == "enum":
        return _enum(field.type)
    if field.kind in ("struct", "any"):
        # null is a legal element of an array on the wire
        return _object(field.type, field.nullable or field.array is not None)
    return _PRIMITIVES[field.kind][0]


def _maker(field: model.Field) -> tuple[str, Callable[[], Any] | None, Any]:
    """(name, None, the constant default) or (name, factory of a fresh default, None)."""
    if field.kind == "enum":
        members = enums[field.type]
        constant: Any = members[field.default] if field.has_default else next(iter(members))
    elif field.kind in ("struct", "any"):
        constant = None
    else:
        constant = field.default if field.has_default else _PRIMITIVES[field.kind][1]
    if field.array is not None:
        count = field.array
        return field.name, (lambda: [constant] * count), None
    if field.kind == "struct" and not field.has_default:
        return field.name, (lambda: types[field.type]()), None
    return field.name, None, constant


def _class(series: str, name: str) -> type[LmcpObject]:
    """The only class of a struct, made on first use."""
    found = _classes.get((series, name))
    if found is None:
        found = _classes[series, name] = _make_class(series, name)
    return found


_classes: dict[tuple[str, str], Any] = {}
_enum_classes: dict[tuple[str, str], Any] = {}


def _make_class(series: str, name: str) -> type[LmcpObject]:
    loaded = model.load(series)
    if name not in loaded.structs:
        raise BadInput("not a struct", item=f"{series}/{name}", expected="a struct's name")
    struct = loaded.structs[name]
    base = types[struct.extends] if struct.extends else LmcpObject
    own = struct.fields
    fields = base.fields + own
    names = tuple(f.name for f in fields)
    getter: Any = attrgetter(*names) if len(names) > 1 else None
    if getter is None:
        getter = (lambda obj: (getattr(obj, names[0]),)) if names else (lambda _obj: ())
    checks = {}
    for field in own:
        one = element_check(field)
        checks[field.name] = one if field.array is None else _array(field, one)
    body = {
        "__slots__": tuple(f.name for f in own),
        "__module__": f"cratous.bridge.lmcp.messages.{series.lower()}",
        "__doc__": describe.docstring(loaded, struct, fields),
        "_restore": staticmethod(again),
        "series": series,
        "type_name": f"{series}/{name}",
        "type_id": struct.id,
        "all_names": (loaded.full_name(name), *base.all_names),
        "fields": fields,
        "names": names,
        "values_of": staticmethod(getter),
        "_makers": base._makers + tuple(_maker(f) for f in own),
        "_checks": {**base._checks, **checks},
    }
    return type(name, (base,), body)


def _enum_class(series: str, name: str) -> Any:
    found = _enum_classes.get((series, name))
    if found is None:
        found = _enum_classes[series, name] = _make_enum_class(series, name)
    return found


def _make_enum_class(series: str, name: str) -> Any:
    loaded = model.load(series)
    if name not in loaded.enums:
        raise BadInput("not an enum", item=f"{series}/{name}", expected="an enum's name")
    make: Any = LmcpEnum  # the functional form creates a subclass
    module = f"cratous.bridge.lmcp.messages.{series.lower()}"
    made = make(name, loaded.enums[name], module=module)
    made.__doc__ = f"{loaded.full_name(name)}: {', '.join(loaded.enums[name])}."
    return made


class _Registry(Mapping[str, Any]):
    """Types by full name, `SERIES/Name` or short name; made on first access."""

    def __init__(self, make: Callable[[str, str], Any], part: str) -> None:
        self._make, self._part = make, part
        self._found: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        found = self._found.get(name)
        if found is None:
            found = self._found[name] = self._make(*model.resolve(name))
        return found

    def __contains__(self, name: object) -> bool:
        try:
            return isinstance(name, str) and self[name] is not None
        except BadInput:
            return False

    def __iter__(self) -> Iterator[str]:
        for series in model.known():
            loaded = model.load(series)
            for name in getattr(loaded, self._part):
                yield loaded.full_name(name)

    def __len__(self) -> int:
        return sum(len(getattr(model.load(s), self._part)) for s in model.known())


__all__ = [
    "LmcpEnum",
    "LmcpObject",
    "again",
    "element_check",
    "enums",
    "full_names",
    "members_of",
    "new",
    "real",
    "real32",
    "types",
    "unknown_field",
    "within",
]

_types, _enums = _Registry(_class, "structs"), _Registry(_enum_class, "enums")
types: Mapping[str, type[Any]] = _types
enums: Mapping[str, Any] = _enums


def members_of(series: str) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """`__getattr__` and `__dir__` of the module with a series' classes and enums."""

    def get(name: str) -> Any:
        loaded = model.load(series)
        if name in loaded.structs:
            return types[f"{series}/{name}"]
        if name in loaded.enums:
            return enums[f"{series}/{name}"]
        raise AttributeError(f"the series {series} has no type {name!r}")

    def names() -> list[str]:
        loaded = model.load(series)
        return [*loaded.enums, *loaded.structs]

    return get, names


def _forget(series: str) -> None:
    for made, registry in ((_classes, _types), (_enum_classes, _enums)):
        registry._found.clear()
        for key in [key for key in made if key[0] == series]:
            del made[key]


model.when_removed(_forget)


def again(name: str, values: tuple[Any, ...]) -> LmcpObject:
    """An object from all its values, unchecked; called by pickle."""
    cls = types[name]
    obj: LmcpObject = object.__new__(cls)
    for field, value in zip(cls.names, values, strict=True):
        setattr(obj, field, value)
    return obj


def new(name: str, **fields: Any) -> Any:
    """A new object of the named type; fields not given have their defaults."""
    return types[name](**fields)


def full_names(obj: LmcpObject) -> tuple[str, ...]:
    """The object's full type name, then those of its bases: the topics on the bus."""
    return obj.all_names
