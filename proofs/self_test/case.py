"""A case of the self-test: a package as text, and the required verdict.

A file begins with `verdict: refused`, `accepted` or `open` (a known gap: it ought to be refused), `because:` (one
plain sentence) and, if it is to be refused, `says:` (what the refusal must contain: items separated by commas, each
with its alternatives separated by `|`). `without: subset` leaves out the list of permitted syntax, to test the checks
behind it. Then the package's files follow, each after a line such as `== spec/meaning.py`. The package is called
`pkg` in them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from cratous.spec.errors import BadInput

CASES = Path(__file__).resolve().parent / "cases"
SECTION = re.compile(r"^== (\S+)\n", re.M)
PACKAGE = re.compile(r"\bpkg\b")
VERDICTS = ("refused", "accepted", "open")
WITHOUT = ("", "subset")
EMPTY = {"__init__.py": "", "spec/__init__.py": ""}


@dataclass(frozen=True)
class Case:
    """A package, as the text of each file, with the required verdict and its reason.

    says: items that the refusal must contain, at least one alternative of each; without: the part of the prover that
    is left out.
    """

    kind: str
    name: str
    verdict: str
    because: str
    says: tuple[tuple[str, ...], ...]
    files: tuple[tuple[str, str], ...]
    without: str = ""

    @property
    def id(self) -> str:
        """`kind/name`."""
        return f"{self.kind}/{self.name}"

    def write(self, folder: Path, package: str) -> None:
        """Write the files as a package of this name into a folder."""
        for place, text in {**EMPTY, **dict(self.files)}.items():
            file = folder / package / place
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(PACKAGE.sub(package, text), encoding="utf-8")

    def unsaid(self, reason: str) -> list[str]:
        """The items of `says` that the reason of a refusal lacks."""
        said = reason.lower()
        return [" or ".join(ways) for ways in self.says if not any(w in said for w in ways)]


def read(file: Path) -> Case:
    """The case in a file; raises BadInput for a malformed one."""
    parts = SECTION.split(file.read_text(encoding="utf-8"))
    head: dict[str, str] = {}
    for line in parts[0].splitlines():
        name, colon, value = line.partition(":")
        if line.strip():
            head[name] = value.strip() if colon else ""
    files = tuple(zip(parts[1::2], parts[2::2], strict=True))
    ways = (word.split("|") for word in head.get("says", "").lower().split(",") if word.strip())
    says = tuple(tuple(way.strip() for way in way_of_it) for way_of_it in ways)
    known = head.get("verdict") in VERDICTS and head.get("without", "") in WITHOUT
    good = known and head.get("because") and files
    if not good or (bool(says) != (head["verdict"] == "refused") and head["verdict"] != "open"):
        raise BadInput(
            "this is no case of the self-test",
            where=f"{file.parent.name}/{file.name}",
            expected="verdict, because and, if refused, says; then `== file` and its text",
        )
    verdict, because, without = head["verdict"], head["because"], head.get("without", "")
    return Case(file.parent.name, file.stem, verdict, because, says, files, without)


def cases(folder: Path = CASES) -> Iterator[Case]:
    """All cases, in order of kind and name."""
    for file in sorted(folder.glob("*/*.case")):
        yield read(file)
