"""Edits of a mission's text that leave everything else unchanged: comments, order, spelling.

An edit is made at the position of the value, and the new text is read again: it must have the
content of the old one with only this change, or the edit is refused. So nothing is lost by editing
on a map.
"""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Mapping
from typing import Any, NoReturn

from cratous.services.loading.document import Key, item_name, loader, parse_document
from cratous.services.mission.frames import Projection
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

PLACE, DEGREES = ("north_m", "east_m"), ("latitude_deg", "longitude_deg")
HEADING, RADIUS = "heading_deg", "radius_m"
_PLAIN = re.compile(r"(?!(true|false|null|yes|no|on|off|y|n)$)[a-z]+(_[a-z]+)*")
"""Strings that YAML cannot read as another type."""


class MissionText:
    """The text of a mission file; where: its name in errors. Raises BadInput if it cannot be read."""

    def __init__(self, text: str, where: str) -> None:
        import yaml

        self.text, self.where = text, where
        self.data: Any = parse_document(text, where).data
        self._root: Any = yaml.compose(text, Loader=loader())
        if not isinstance(self.data, dict):
            self._refuse("this is no mission", (), "a mapping, such as name: crossing")

    def moved(self, key: Key, north_m: float, east_m: float) -> str:
        """The text with a position (a mapping or a corner) changed, to a decimetre.

        A position in degrees stays in degrees.
        """
        place = self._value(key)
        if isinstance(place, list) and len(place) == 2:
            return self._with({(*key, 0): _tenths(north_m), (*key, 1): _tenths(east_m)})
        if isinstance(place, dict) and set(PLACE) <= set(place):
            values = _tenths(north_m), _tenths(east_m)
            return self._with({(*key, n): v for n, v in zip(PLACE, values, strict=True)})
        if isinstance(place, dict) and set(DEGREES) <= set(place):
            frame = self.data["frame"]
            home = Frame(float(frame["latitude_deg"]), float(frame["longitude_deg"]))
            found = Projection(home).to_geodetic(north_m, east_m)
            said = [f"{degrees:.7f}" for degrees in found]
            return self._with({(*key, n): v for n, v in zip(DEGREES, said, strict=True)})
        self._refuse("this is no place", key, "north_m and east_m, degrees, or a corner")

    def with_number(self, key: Key, value: float) -> str:
        """The text with a heading [deg] or radius [m] replaced, to a tenth."""
        node = self._node(key)
        if not key or key[-1] not in (HEADING, RADIUS) or node is None or node.id != "scalar":
            self._refuse(
                "this is no heading or radius", key, f"a {HEADING} or {RADIUS} of the file"
            )
        return self._with({key: _tenths(value)})

    def put(self, key: Key, value: str) -> str:
        """The text with a string replaced, or appended if missing."""
        node = self._node(key)
        if node is not None:
            if node.id != "scalar":
                self._refuse("this is no text", key, "a text")
            return self._with({key: json.dumps(value, ensure_ascii=False)}, value)
        if len(key) != 1:
            self._refuse("there is no such value", key, "a value of the file")
        return self._at_end(f"{key[0]}: {json.dumps(value, ensure_ascii=False)}\n", key, value)

    def added(self, name: str, item: Mapping[str, Any]) -> str:
        """The text with one more item appended to a list of the file, such as its zones."""
        node, value = self._node((name,)), copy.deepcopy(dict(item))
        wanted = copy.deepcopy(self.data)
        if node is None:
            return self._at_end(f"{name}:\n{_block(item, '  ')}", (name,), [value])
        if not isinstance(wanted[name], list):
            self._refuse("this is no list", (name,), "a list")
        wanted[name].append(value)
        if node.flow_style:
            end = node.end_mark.index - 1
            comma = ", " if node.value else ""
            new = f"{self.text[:end].rstrip()}{comma}{_flow(item)}{self.text[end:]}"
        else:
            end = self._line_end(node)
            block = _block(item, " " * node.start_mark.column)
            new = f"{self.text[:end]}\n{block.rstrip()}{self.text[end:]}"
        return self._held(new, wanted, (name,))

    def removed(self, key: Key) -> str:
        """The text without an item of a list; without the list if it was the only one."""
        if self._node(key) is None or not key or not isinstance(key[-1], int):
            self._refuse("there is no such item", key, "an item of a list")
        listed: Any = self._node(key[:-1])
        wanted = copy.deepcopy(self.data)
        holder: Any = wanted
        for part in key[:-1]:
            holder = holder[part]
        if listed.flow_style:
            del holder[key[-1]]
            return self._held(self._without_flow(listed.value, key[-1]), wanted, key)
        if len(listed.value) == 1:
            if len(key) != 2:
                self._refuse("the only one of a list within", key, "a change in the text")
            del wanted[key[0]]
            name = next(n for n, _ in self._root.value if n.value == key[0])
            begin = self._line_begin(name.start_mark.index)
        else:
            del holder[key[-1]]
            dash = len(self.text[: listed.value[key[-1]].start_mark.index].rstrip()) - 1
            begin = self._line_begin(dash)
        end = self._line_end(listed.value[key[-1]])
        return self._held(self.text[:begin] + self.text[end + 1 :], wanted, key)

    def _without_flow(self, items: list[Any], number: int) -> str:
        this = items[number]
        begin, end = this.start_mark.index, this.end_mark.index
        if number + 1 < len(items):
            end = items[number + 1].start_mark.index
        elif number:
            begin = items[number - 1].end_mark.index
        return self.text[:begin] + self.text[end:]

    def _node(self, key: Key) -> Any:
        node = self._root
        for part in key:
            values = node.value if isinstance(node.value, list) else []
            if isinstance(part, int):
                if node.id != "sequence" or part not in range(len(values)):
                    return None
                node = values[part]
            else:
                named = {n.value: v for n, v in values} if node.id == "mapping" else {}
                if part not in named:
                    return None
                node = named[part]
        return node

    def _value(self, key: Key) -> Any:
        if self._node(key) is None:
            self._refuse("there is no such value", key, "a value of the file")
        value = self.data
        for part in key:
            value = value[part]
        return value

    def _with(self, said: Mapping[Key, str], value: str | None = None) -> str:
        """The text with scalars replaced; value: the meaning of a single one that is not a number."""
        wanted, new = copy.deepcopy(self.data), self.text
        for key, text in said.items():
            holder = wanted
            for part in key[:-1]:
                holder = holder[part]
            holder[key[-1]] = float(text) if value is None else value
        spans = {
            key: (self._node(key).start_mark.index, self._end(self._node(key))) for key in said
        }
        for key, (begin, end) in sorted(spans.items(), key=lambda one: one[1], reverse=True):
            new = new[:begin] + said[key] + new[end:]
        return self._held(new, wanted, next(iter(said)))

    def _at_end(self, block: str, key: Key, value: Any) -> str:
        wanted = {**copy.deepcopy(self.data), key[0]: value}
        return self._held(f"{self.text.rstrip()}\n\n{block}", wanted, key)

    def _end(self, node: Any) -> int:
        """Position after a value's last character, without trailing blanks that YAML includes."""
        last = node
        while not isinstance(last.value, str) and not last.flow_style and last.value:
            last = last.value[-1][1] if last.id == "mapping" else last.value[-1]
        return len(self.text[: last.end_mark.index].rstrip())

    def _line_end(self, node: Any) -> int:
        """End of the line on which a value ends."""
        found = self.text.find("\n", self._end(node))
        return len(self.text) if found < 0 else found

    def _line_begin(self, index: int) -> int:
        return self.text.rfind("\n", 0, index) + 1

    def _held(self, new: str, wanted: Any, key: Key) -> str:
        """The new text, if it has the wanted content."""
        try:
            said = parse_document(new, self.where).data
        except BadInput:
            said = None
        if said != wanted:
            self._refuse(
                "this cannot be changed here without changing more", key, "a change in the text"
            )
        return new

    def _refuse(self, what: str, key: Key, expected: str) -> NoReturn:
        raise BadInput(what, where=self.where, item=item_name(key), expected=expected)


def _tenths(value: float) -> str:
    text = f"{value:.1f}".removesuffix(".0")
    return "0" if text == "-0" else text


def _flow(value: Any) -> str:
    """The value in YAML flow style, on one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{name}: {_flow(one)}" for name, one in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_flow, value)) + "]"
    if isinstance(value, str) and _PLAIN.fullmatch(value):
        return value
    return json.dumps(value, ensure_ascii=False)


def _block(item: Mapping[str, Any], indent: str) -> str:
    """The item of a list in YAML block style, a line for each value."""
    lines = [f"{name}: {_flow(value)}" for name, value in item.items()]
    return "".join(f"{indent}{'- ' if k == 0 else '  '}{line}\n" for k, line in enumerate(lines))
