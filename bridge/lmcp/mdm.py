"""MDM files: the XML in which LMCP series are defined, read into models at run time.

    from cratous.bridge.lmcp import mdm
    mdm.load("MYSERIES.xml")            # its types are then known to every form of the codec

`<MDM>` holds SeriesName (at most 8 ASCII characters), Namespace (with `/`), Version (uint16), an
EnumList and a StructList. An enum entry without Value has its index; a struct without ID gets the
next number in file order, from one above the largest given. A type is a primitive, a name
of its own series or `SERIES/Name` (or Series="SERIES"), followed by `[]` or `[n]` for arrays.
Default is null for structs, and ignored for arrays; an empty attribute counts as absent. Every
mistake is an error with file and line. The DTD is not read. Format: LmcpGen (MDM.DTD).
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from cratous.bridge.lmcp import model, xml
from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import bytes_of

PRIMITIVES = ("bool", "char", "string", "real32", "real64", *model.INTEGER_RANGES)
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_SERIES = re.compile(r"[A-Za-z0-9_]{1,8}\Z")
_TYPE = re.compile(r"(?:([A-Za-z0-9_]+)/)?([A-Za-z_][A-Za-z0-9_]*)(?:\[([0-9]*)\])?\Z")
_MAX_ID = 2**32 - 1
_ATTRIBUTES = {
    "Struct": {"Name", "Extends", "Series", "ID"},
    "Field": {
        "Name", "Type", "Series", "Default", "Units", "LargeArray", "MaxArrayLength", "Optional",
    },
    "Enum": {"Name"},
    "Entry": {"Name", "Value"},
}  # fmt: skip
# Names that a Python class of a message already has, and so no field can have.
_TAKEN = re.compile(
    r"(series|type_name|type_id|all_names|fields|names|values_of|copy|checked|_.*)\Z"
)


def load(*paths: str | Path) -> tuple[str, ...]:
    """Read MDM files and register their series together; returns the names of those that are new.

    Raises BadInput (file and line) for a mistake, and for a series that is already known with another content.
    """
    return model.add(read_all(paths))


def read_all(paths: Iterable[str | Path]) -> list[model.Series]:
    """The models of several files that may refer to each other; nothing is registered."""
    files = [(bytes_of(Path(path), expected="an MDM file"), str(path)) for path in paths]
    drafts = [_Draft(data, where) for data, where in files]
    names = {draft.name: draft for draft in drafts}
    return [model.from_dict(draft.data(names)) for draft in drafts]


def parse(data: bytes | str, where: str = "MDM") -> dict[str, Any]:
    """The model of one file in the form of `spec/lmcp/<SERIES>.json`; BadInput with the line."""
    draft = _Draft(data, where)
    return draft.data({draft.name: draft})


class _Draft:
    """One file whose names are known, but whose fields are not resolved yet."""

    def __init__(self, data: bytes | str, where: str) -> None:
        self.where = where
        self.root = xml.parse(data, where)
        if self.root.tag != "MDM":
            raise self.wrong(
                self.root, "not an MDM file", expected="<MDM>", got=f"<{self.root.tag}>"
            )
        parts = _children(
            self, self.root, "SeriesName Namespace Version Comment EnumList StructList"
        )
        for name in ("SeriesName", "Namespace"):
            if name not in parts:
                raise self.wrong(self.root, "part is missing", expected=f"<{name}>")
        self.name = (parts["SeriesName"].text or "").strip()
        if not _SERIES.match(self.name):
            expected = "1 to 8 letters, digits and _"
            raise self.wrong(parts["SeriesName"], "wrong series name", expected, self.name)
        self.namespace = (parts["Namespace"].text or "").strip()
        if not all(_NAME.match(part) for part in self.namespace.split("/")):
            raise self.wrong(parts["Namespace"], "wrong namespace", "names and '/'", self.namespace)
        self.version = 0
        if "Version" in parts:
            text = (parts["Version"].text or "").strip()
            self.version = self.whole(parts["Version"], "version", text, 0, 2**16 - 1)
        self.enums = self.listed(parts.get("EnumList"), "Enum")
        self.structs = self.listed(parts.get("StructList"), "Struct")
        for name in self.enums.keys() & self.structs.keys():
            raise self.wrong(self.structs[name], "name of an enum and a struct", got=name)

    def wrong(self, element: Any, what: str, expected: str = "", got: str = "") -> BadInput:
        place = f"{self.where}:{element.sourceline or 1}"
        return BadInput(what, where=place, item=_item(element), expected=expected, got=got)

    def whole(self, element: Any, what: str, text: str, low: int, high: int) -> int:
        if not re.match(r"[+-]?[0-9]{1,20}\Z", text) or not low <= int(text) <= high:
            raise self.wrong(element, f"wrong {what}", f"a whole number from {low} to {high}", text)
        return int(text)

    def listed(self, parent: Any, tag: str) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for element in () if parent is None else parent:
            name = element.get("Name", "")
            if element.tag == "Comment":
                continue
            if element.tag != tag:
                raise self.wrong(element, "wrong element", f"<{tag}>", f"<{element.tag}>")
            self.nothing_else(element, _ATTRIBUTES[tag])
            if not _NAME.match(name) or name in PRIMITIVES or name == model.ANY:
                raise self.wrong(element, "wrong name", "a name that is free", repr(name))
            if name in found:
                raise self.wrong(element, "name given twice", got=name)
            found[name] = element
        return found

    def nothing_else(self, element: Any, attributes: set[str]) -> None:
        """Refuse attributes and text that would otherwise be ignored."""
        for name in element.keys():  # noqa: SIM118 (an lxml element, not a dictionary)
            if name not in attributes:
                expected = " or ".join(sorted(attributes)) or "none"
                raise self.wrong(element, "unknown attribute", expected, name)
        texts = [element.text, *(child.tail for child in element)]
        for text in texts:
            if text and text.strip():
                raise self.wrong(element, "text between elements", got=repr(text.strip())[:60])

    def data(self, drafts: dict[str, _Draft]) -> dict[str, Any]:
        enums = {name: self.entries(element) for name, element in self.enums.items()}
        ids = self.ids()
        structs = []
        for name, element in self.structs.items():
            struct: dict[str, Any] = {"name": name, "id": ids[name]}
            if element.get("Extends"):
                struct["extends"] = self.parent(element, drafts)
            struct["fields"] = [self.field(f, drafts) for f in self.named(element, "Field")]
            structs.append(struct)
        self.inherited_names(structs, drafts)
        return {
            "series": self.name,
            "namespace": self.namespace,
            "version": self.version,
            "enums": enums,
            "structs": structs,
        }

    def named(self, element: Any, tag: str) -> Iterator[Any]:
        yield from self.listed(element, tag).values()

    def entries(self, enum: Any) -> dict[str, int]:
        values: dict[str, int] = {}
        for place, entry in enumerate(self.named(enum, "Entry")):
            text = entry.get("Value") or str(place)
            value = self.whole(entry, "value", text, -(2**31), 2**31 - 1)
            if value in values.values():
                raise self.wrong(entry, "value given twice", got=text)
            values[entry.get("Name")] = value
        if not values:
            raise self.wrong(enum, "enum without entries")
        return values

    def ids(self) -> dict[str, int]:
        given: dict[str, int] = {}
        for name, element in self.structs.items():
            text = element.get("ID")
            if text:
                given[name] = self.whole(element, "ID", text.strip(), 1, _MAX_ID)
                if list(given.values()).count(given[name]) > 1:
                    raise self.wrong(element, "ID given twice", got=text)
        following = max(given.values(), default=0) + 1
        result = {}
        for name in self.structs:
            result[name] = given.get(name, following)
            following += name not in given
        return result

    def parent(self, element: Any, drafts: dict[str, _Draft]) -> str:
        match = _TYPE.match(element.get("Extends").strip())
        if not match or match.group(3) is not None:
            raise self.wrong(element, "wrong parent", "a struct's name", element.get("Extends"))
        series = match.group(1) or element.get("Series") or self.name
        kind, full = self.kind_of(element, series, match.group(2), drafts)
        if kind != "struct":
            raise self.wrong(element, "wrong parent", "a struct's name", full)
        return full

    def kind_of(
        self, element: Any, series: str, name: str, drafts: dict[str, _Draft]
    ) -> tuple[str, str]:
        full = f"{series}/{name}"
        if series in drafts:
            enums, structs = set(drafts[series].enums), set(drafts[series].structs)
        elif series in model.known():
            known = model.load(series)
            enums, structs = set(known.enums), set(known.structs)
        else:
            expected = " or ".join(dict.fromkeys((*drafts, *model.known())))
            raise self.wrong(element, "unknown series", expected, series)
        if name in enums or name in structs:
            return ("enum" if name in enums else "struct"), full
        raise self.wrong(element, "unknown type", "a primitive, enum or struct", full)

    def field(self, element: Any, drafts: dict[str, _Draft]) -> dict[str, Any]:
        name, text = element.get("Name"), (element.get("Type") or "").strip()
        if _TAKEN.match(name):
            raise self.wrong(element, "name that the classes of messages use themselves", got=name)
        match = _TYPE.match(text)
        if not match:
            raise self.wrong(element, "wrong type", "a type, `[]` or `[n]` behind it", repr(text))
        series, short, size = match.groups()
        field: dict[str, Any] = {"name": name}
        series = series or element.get("Series") or None
        if series is None and short in PRIMITIVES:
            kind = field["type"] = short
        elif series is None and short == model.ANY:
            kind, field["type"] = "any", short
        else:
            kind, field["type"] = self.kind_of(element, series or self.name, short, drafts)
        if kind != field["type"]:
            field["kind"] = kind
        if size is not None:
            field["array"] = (
                self.whole(element, "array", size, 1, 2**16 - 1) if size else "variable"
            )
        if self.flag(element, "LargeArray"):
            if field.get("array") != "variable":
                raise self.wrong(element, "LargeArray of what is no variable array", got=text)
            field["large"] = True
        if element.get("Default") and size is None:
            field["default"] = self.default(element, kind, field, drafts)
        elif kind == "any" and size is None:
            field["default"] = None
        if element.get("Units", "").lower() not in ("", "none"):
            field["units"] = element.get("Units")
        if element.get("MaxArrayLength"):
            length = element.get("MaxArrayLength").strip()
            field["max_length"] = self.whole(element, "MaxArrayLength", length, 0, _MAX_ID)
        if self.flag(element, "Optional"):
            field["optional"] = True
        return field

    def flag(self, element: Any, name: str) -> bool:
        text = element.get(name, "false").strip().lower()
        if text not in ("true", "false"):
            raise self.wrong(element, f"wrong {name}", "true or false", text)
        return text == "true"

    def default(
        self, element: Any, kind: str, field: dict[str, Any], drafts: dict[str, _Draft]
    ) -> Any:
        text = element.get("Default")
        if kind == "string":
            return text
        text = text.strip()
        if kind in ("struct", "any"):
            if text != "null":
                raise self.wrong(element, "wrong default", "null", text)
            return None
        if kind == "bool":
            if text.lower() not in ("true", "false"):
                raise self.wrong(element, "wrong default", "true or false", text)
            return text.lower() == "true"
        if kind == "char":
            if len(text) != 1 or ord(text) > 255:
                raise self.wrong(element, "wrong default", "one character", text)
            return text
        if kind == "enum":
            series, _, short = field["type"].partition("/")
            owner = drafts.get(series)
            names = owner.entries(owner.enums[short]) if owner else model.load(series).enums[short]
            if text not in names:
                raise self.wrong(element, "wrong default", " or ".join(names), text)
            return text
        if kind in model.INTEGER_RANGES:
            return self.whole(element, "default", text, *model.INTEGER_RANGES[kind])
        try:
            number = float(text)
        except ValueError:
            number = math.nan
        if not math.isfinite(number) or (kind == "real32" and abs(number) > 3.4028235e38):
            raise self.wrong(element, "wrong default", f"a number within {kind}", text)
        return number

    def inherited_names(self, structs: list[dict[str, Any]], drafts: dict[str, _Draft]) -> None:
        """Refuse a struct that extends itself, or has a field with the name of an inherited one."""
        for struct in structs:
            element = self.structs[struct["name"]]
            own = {f["name"] for f in struct["fields"]}
            seen = {f"{self.name}/{struct['name']}"}
            parent = struct.get("extends")
            while parent:
                if parent in seen:
                    raise self.wrong(element, "struct that extends itself", got=parent)
                seen.add(parent)
                series, _, short = parent.partition("/")
                if series in drafts:
                    owner = drafts[series]
                    above = owner.structs[short]
                    fields = {f.get("Name") for f in owner.named(above, "Field")}
                    parent = owner.parent(above, drafts) if above.get("Extends") else ""
                else:
                    known = model.load(series).structs[short]
                    fields, parent = {f.name for f in known.fields}, known.extends
                if own & fields:
                    names = ", ".join(sorted(own & fields))
                    raise self.wrong(element, "field of an ancestor given again", got=names)


def _item(element: Any) -> str:
    names = [e.get("Name") for e in (*reversed(list(element.iterancestors())), element)]
    return ".".join(name for name in names if name)


def _children(draft: _Draft, parent: Any, allowed: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for element in parent:
        if element.tag not in allowed.split():
            raise draft.wrong(element, "wrong element", allowed, f"<{element.tag}>")
        if element.tag in found:
            raise draft.wrong(element, "element given twice", got=f"<{element.tag}>")
        found[element.tag] = element
        if element.tag in ("EnumList", "StructList"):
            draft.nothing_else(element, set())
    return found


def dumps(data: dict[str, Any]) -> str:
    """The text of a model's JSON file, one line per field, like the files of `spec/lmcp`."""

    def compact(value: Any) -> str:
        return json.dumps(value, ensure_ascii=False)

    enums = ",\n".join(f"    {compact(n)}: {compact(v)}" for n, v in data["enums"].items())
    structs = []
    for struct in data["structs"]:
        head = compact({k: v for k, v in struct.items() if k != "fields"})[:-1]
        fields = ",\n".join(f"      {compact(f)}" for f in struct["fields"])
        structs.append(f'    {head}, "fields": [' + (f"\n{fields}\n    ]}}" if fields else "]}"))
    head = ",\n".join(
        f"  {compact(k)}: {compact(data[k])}" for k in ("series", "namespace", "version")
    )
    body = ",\n".join(structs)
    enums = f"{{\n{enums}\n  }}" if enums else "{\n  }"
    return f'{{\n{head},\n  "enums": {enums},\n  "structs": [\n{body}\n  ]\n}}\n'
