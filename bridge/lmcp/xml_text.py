"""XML text to elements; and repair of malformed XML that the original's reader accepts.

Two cases occur in files that OpenUxAS ships: comments with `--` inside, and a message file whose last end tag is
missing. Nothing else is repaired; a repair changes no element and no line number, and each is noted.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from cratous.spec.errors import BadInput
from cratous.spec.files.limits import DOCUMENT_BYTES, TAGS, at_most

_TAG = re.compile(rb"<(/?)([A-Za-z_][\w.:-]*)[^<>]*?(/?)>")
_HIDING = ((b"<!--", b"-->"), (b"<![CDATA[", b"]]>"), (b"<?", b"?>"))


def parse(text: str | bytes, where: str = "text") -> Any:
    """The root element of an XML text, read without entities, network or comments."""
    from lxml import etree

    parser = etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        huge_tree=False,
        load_dtd=False,
        remove_comments=True,
        remove_pis=True,
    )
    data = text.encode("utf-8") if isinstance(text, str) else text
    if isinstance(text, str):  # a declared encoding no longer applies to decoded text
        data = re.sub(rb"\A(<\?xml[^>]*?)\s+encoding=(\"[^\"]*\"|'[^']*')", rb"\1", data)
    at_most(len(data), DOCUMENT_BYTES, "the XML is too long", where)
    at_most(data.count(b"<"), TAGS, "too many elements", where, "tags")
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as err:
        line = err.lineno or 1
        raise BadInput(
            "not well-formed XML", where=f"{where}:{line}", expected="XML", got=err.msg or str(err)
        ) from None
    for node in root.iter():
        if not isinstance(node.tag, str):
            raise BadInput(
                "entity in XML",
                where=f"{where}:{node.sourceline or 1}",
                expected="no entities but the five of XML",
                got=str(node.text),
            )
    return root


def mended(data: bytes, where: str, notes: list[str]) -> bytes:
    """The text repaired to XML if possible; unchanged if it is XML already, or cannot be repaired."""
    try:
        parse(data, where)
        return data
    except BadInput:
        pass
    found: list[str] = []
    text, tags = bytearray(data), bytearray(data)
    line, counted = 1, 0
    for start, end in _hidden(data):
        _blank(tags, start, end)
        if data.startswith(b"<!--", start) and b"--" in data[start + 4 : end - 2]:
            _blank(text, start, end)
            line += data.count(b"\n", counted, start)
            counted = start
            found.append(f"{where}:{line}: a comment has -- inside, which XML forbids; skipped")
    open_tags = _left_open(bytes(tags))
    if len(open_tags) == 1:
        name = open_tags[0].decode("utf-8", "replace")
        found.append(f"{where}: the last end tag, </{name}>, is missing; read as if it were there")
        text += b"</" + open_tags[0] + b">"
    try:
        parse(bytes(text), where)
    except BadInput:
        return data  # unchanged, so that the error refers to the file's content
    notes.extend(found)
    return bytes(text)


def _hidden(data: bytes) -> Iterator[tuple[int, int]]:
    """Spans of the text in which there are no tags: comments, character data, instructions."""
    at = data.find(b"<")
    while at >= 0:
        end = at + 1
        for begins, ends in _HIDING:
            if data.startswith(begins, at):
                close = data.find(ends, at + len(begins))
                if close < 0:
                    return
                end = close + len(ends)
                yield at, end
                break
        at = data.find(b"<", end)


def _blank(text: bytearray, start: int, end: int) -> None:
    """Replace a part with blanks; its line ends are kept."""
    text[start:end] = re.sub(rb"[^\r\n]", b" ", bytes(text[start:end]))


def _left_open(text: bytes) -> list[bytes]:
    """The names of the elements without an end tag, outermost first; none if tags are not properly nested."""
    names: list[bytes] = []
    for end, name, empty in _TAG.findall(text):
        if end:
            if not names or names.pop() != name:
                return []
        elif not empty:
            names.append(name)
    return names
