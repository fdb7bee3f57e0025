"""Units of message fields according to the message models, in the unit names of requirements."""

from __future__ import annotations

from cratous.bridge.lmcp import model
from cratous.spec.errors import BadInput

NAMES = {
    "meter": "m", "meters": "m", "meters msl": "m", "m": "m",
    "meter/sec": "m/s", "meters/sec": "m/s", "mps": "m/s", "m/s": "m/s",
    "meter/sec/sec": "m/s^2",
    "degree": "deg", "degrees": "deg", "deg": "deg",
    "degree/sec": "deg/s", "degree/second": "deg/s", "degrees/sec": "deg/s",
    "millisecond": "ms", "milliseconds": "ms", "milliseconds since 1 jan 1970": "ms", "sec": "s",
    "%": "%",
}  # fmt: skip


def is_known(message: str) -> bool:
    """Whether the models have a message type of this name."""
    try:
        model.resolve(message)
    except BadInput:
        return False
    return True


def unit_of(message: str, path: str) -> str:
    """The unit of a field, by a path of names from a message type; "" if the models have none.

    Raises BadInput for a path that a known type does not have.
    """
    field = _field(message, path)
    return "" if field is None else NAMES.get(field.units.lower(), "")


def refuse_no_word(message: str, path: str, word: str, item: str) -> None:
    """BadInput if, by the models, a field never has this enumeration value."""
    field = _field(message, path)
    if field is None or field.kind == "string":
        return
    words: tuple[str, ...] = ()
    if field.kind == "enum":
        series, _, name = field.type.partition("/")
        words = tuple(model.load(series).enums[name])
    if word not in words:
        expected = ", ".join(words) or "a field that is a word"
        raise BadInput("the field is never this word", item=item, expected=expected, got=word)


def _field(message: str, path: str) -> model.Field | None:
    try:
        series, name = model.resolve(message)
    except BadInput:
        return None  # a type known only to the log
    field: model.Field | None = None
    for part in path.split("."):
        if part.isdecimal():
            continue  # an index into a list
        fields = _fields(series, name)
        field = fields.get(part)
        if field is None:
            raise BadInput(
                "the message type has no such field", item=f"{message}.{path}",
                expected=", ".join(fields) or "nothing below it", got=part,
            )  # fmt: skip
        if field.kind == "any":
            return None  # the type of its content is known only at run time
        series, _, name = field.type.partition("/") if field.kind == "struct" else ("", "", "")
    return field


def _fields(series: str, name: str) -> dict[str, model.Field]:
    found: dict[str, model.Field] = {}
    while name:
        struct = model.load(series).structs.get(name)
        if struct is None:
            break
        found = {**{field.name: field for field in struct.fields}, **found}
        series, _, name = struct.extends.partition("/")
    return found
