"""Requirements files with everything they import, as texts: kept in a report so that it can be
judged again.

A file is read once; from then on its stored text applies. Included files and FRET exports are
stored with it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from cratous.services.requirements import language
from cratous.services.requirements.arithmetic import sources
from cratous.services.requirements.formula import signals
from cratous.services.requirements.including import (
    LIBRARY,
    SUFFIX,
    libraries,
    library_text,
    text_at,
)
from cratous.services.requirements.specification import Specification
from cratous.services.requirements.traces import wanted_of
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CONFIG_BYTES, DOCUMENT_BYTES
from cratous.spec.files.text_file import text_of

MOST_FILES = 50
TAKEN = re.compile("G[1-5]")
"""Ids already used by a report."""


class OwnFile(NamedTuple):
    """One file. name: as given, never an absolute path; imports: included files and exports, by name."""

    name: str
    text: str
    imports: tuple[tuple[str, str], ...] = ()

    def data(self) -> dict[str, Any]:
        """The form in which a report stores it."""
        imports = [
            {"file": name, "sha256": digest(text), "text": text} for name, text in self.imports
        ]
        said = {"file": self.name, "sha256": digest(self.text), "text": self.text}
        return {**said, "imports": imports}

    @property
    def named(self) -> dict[str, Any]:
        """Only the names and digests."""
        parts = [{"file": name, "sha256": digest(text)} for name, text in self.imports]
        return {"file": self.name, "sha256": digest(self.text), "imports": parts}

    def specification(self) -> Specification:
        """The parsed requirements; BadInput if no flight log can be checked against them."""
        found = language.read(self.text, self.name, dict(self.imports))
        needed: set[str] = set()
        for one in found.requirements:
            needed |= sources(signals(one.judged), found.signals)
        wanted_of(found, needed)
        return found


class _Gathered(dict[str, str]):
    """The texts of files in a folder, each read at first access."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __contains__(self, _name: object) -> bool:
        return True

    def __missing__(self, name: str) -> str:
        if name.endswith(SUFFIX) or name.startswith(LIBRARY):
            self[name] = text_at(self.folder, name)
        else:
            self[name] = text_of(self.folder / name, DOCUMENT_BYTES, "an export of FRET")
        return self[name]


def _is_unicode(name: str) -> bool:
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True


class _Taken(dict[str, str]):
    """Texts by name, recording which were accessed."""

    def __init__(self, texts: Iterable[tuple[str, str]]) -> None:
        super().__init__(texts)
        self.asked: set[str] = set()

    def __getitem__(self, name: str) -> str:
        self.asked.add(name)
        return super().__getitem__(name)


def digest(text: str) -> str:
    """SHA-256 of a text as stored in a file; UnicodeEncodeError if it cannot be encoded."""
    return sha256(text.encode()).hexdigest()


def own_file(path: Path, name: str) -> OwnFile:
    """Read a requirements file of the product's language with all its imports; name: its display
    name.

    BadInput for an invalid file, or one that no flight log can be checked against.
    """
    if path.suffix != ".req":
        raise BadInput("these requirements count samples", where=str(path), expected="a file *.req")
    if not _is_unicode(name):
        shown = name.encode("ascii", "backslashreplace").decode()
        expected = "a name in Unicode, as reports and logs have it"
        raise BadInput("this name cannot be kept", where=shown, expected=expected)
    text = text_of(path, CONFIG_BYTES, "requirements")
    gathered = _Gathered(path.parent)
    language.read(text, str(path), gathered)
    found = OwnFile(name, text, tuple(sorted(gathered.items())))
    found.specification()
    return found


def refuse_clashes(files: Iterable[OwnFile]) -> None:
    """BadInput if two files have one name, two requirements one id, or one has the id of a guarantee."""
    names: set[str] = set()
    ids: dict[str, str] = {}
    for number, file in enumerate(files, 1):
        if file.name in names or number > MOST_FILES:
            expected = f"at most {MOST_FILES} files, each once"
            raise BadInput(
                "these files cannot be judged together", item=file.name, expected=expected
            )
        names.add(file.name)
        for one in file.specification().requirements:
            if TAKEN.fullmatch(one.name):
                expected = "another id than those of the guarantees, G1 to G5"
                raise BadInput("the id is taken", where=file.name, item=one.name, expected=expected)
            if one.name in ids:
                raise BadInput(
                    "two requirements have one id", where=f"{ids[one.name]} and {file.name}",
                    item=one.name, expected="ids that differ",
                )  # fmt: skip
            ids[one.name] = file.name


def files_of(data: Any) -> tuple[OwnFile, ...]:
    """The files that a report stores; BadInput for an invalid list, or a digest that differs from its text."""
    try:
        found = [(one, tuple(one["imports"])) for one in data]
        texts = [part for one, imports in found for part in (one, *imports)]
        other = [t["file"] for t in texts if digest(t["text"]) != t["sha256"]]
        good = all(isinstance(t["file"], str) and t["file"].encode() for t in texts)
    except (TypeError, KeyError, AttributeError, UnicodeEncodeError):
        raise BadInput("these are no files of requirements", item="own.files") from None
    if not good:
        raise BadInput("a file has no name", item="own.files")
    if other:
        raise BadInput("its text has another digest than is said", item=other[0])
    files = tuple(
        OwnFile(one["file"], one["text"], tuple((p["file"], p["text"]) for p in imports))
        for one, imports in found
    )
    refuse_clashes(files)
    for file in files:
        taken = _Taken(file.imports)
        language.read(file.text, file.name, taken)
        names = [name for name, _ in file.imports]
        if names != sorted(taken.asked):
            raise BadInput(
                "its imports are others than it takes, each once, by name", item=file.name,
                expected=", ".join(sorted(taken.asked)) or "none", got=", ".join(names) or "none",
            )  # fmt: skip
    return files


def other_libraries(files: Iterable[OwnFile]) -> list[str]:
    """Libraries of the product included with a text that differs from this version's, in words."""
    shipped, found = libraries(), []
    for file in files:
        for name, text in file.imports:
            library = name.removeprefix(LIBRARY)
            if library == name or (library in shipped and text == library_text(library)):
                continue
            found.append(f"{file.name}: {name} is another text than this version of CRATOUS has")
    return found


def line_of(text: str, name: str) -> int | None:
    """The line on which a requirement begins; None if it is imported."""
    found = re.search(rf"^[ \t]*requirement[ \t]+{re.escape(name)}(?![\w.-])", text, re.MULTILINE)
    return None if found is None else text.count("\n", 0, found.start()) + 1
