"""The lint of decisions outside of kernels and drivers.

Services and bridge may measure, draw and steer, but what must hold of geometry, time or authority is decided by a
kernel. This lint reads their syntax trees and lists every place that looks like such a decision: a comparison that
involves a measured quantity (by the naming convention `_m _s _ms _rad`, `owner`, `epoch`, a distance function, a
cross or matrix product), and a geometric predicate of a library. Each place is either explained, with one line, in
`decisions.json`, or a finding. An explanation without a place is a finding too.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from cratous.core.kernel.sources import ROOT

PARTS = ("services", "bridge")
SUFFIXES = ("_m", "_s", "_ms", "_rad")
AUTHORITY = {"owner", "epoch"}
MEASURES = {"hypot", "dist", "distance", "hausdorff_distance"}
PREDICATES = {
    "contains", "contains_properly", "intersects", "within", "touches", "crosses", "covers",
    "covered_by", "disjoint", "overlaps", "dwithin", "is_ccw",
}  # fmt: skip
FILE = Path(__file__).with_name("decisions.json")
KINDS = {
    "display": "only shown or counted, no verdict depends on it",
    "guidance": "steers; what is flown is judged by kernels in the monitor",
    "prefilter": "leaves work out; what it lets through is re-checked by a kernel",
    "input": "range check of input, refused with a message",
    "clock": "when something is due or begins, not whether it holds",
    "world": "moves the simulated world, whose every motion the product has to cope with",
    "open": "a decision that has no kernel yet",
}


@dataclass(frozen=True)
class Place:
    """A comparison outside of kernels: file, function, text and subject."""

    file: str
    line: int
    function: str
    text: str
    subject: str

    @property
    def name(self) -> str:
        """The place as `decisions.json` names it."""
        return f"{self.file}:{self.function}"

    def __str__(self) -> str:
        lesson = {
            "authority": "who may command is decided by the kernels of core/authority/gate.py",
            "geometry": "use a kernel or fold of core (locate, meets_boundary, on_segment ...)",
            "measure": "compare with a kernel of core, on values that it is proved for",
        }[self.subject]
        return (
            f"{self.file}:{self.line}: {self.function} decides `{self.text}` itself: {lesson}; "
            f"or, if nothing that must hold depends on it, say in one line of proofs/{FILE.name} why"
        )


@dataclass(frozen=True)
class Explanation:
    """An entry of `decisions.json`: functions of a file, the kind of decision, the reason.

    `*` as the function of a folder (its name ends in `/`) covers all of the folder; only for the kind `world`.
    """

    file: str
    functions: tuple[str, ...]
    kind: str
    reason: str

    def covers(self, place: Place) -> bool:
        """True iff the entry applies to this place."""
        if self.functions == ("*",):
            return self.kind == "world" and place.file.startswith(self.file)
        return place.file == self.file and place.function in self.functions


def _names(node: ast.AST) -> Iterator[str]:
    for part in ast.walk(node):
        if isinstance(part, ast.Name):
            yield part.id
        elif isinstance(part, ast.Attribute):
            yield part.attr


def _zero(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and node.value == 0 and not isinstance(node.value, bool)


def _product(node: ast.AST) -> bool:
    """Whether it is a cross product `a * b - c * d` or a matrix product, as used for containment tests."""
    if not isinstance(node, ast.BinOp):
        return False
    if isinstance(node.op, ast.MatMult):
        return True
    sides = (node.left, node.right)
    times = [isinstance(s, ast.BinOp) and isinstance(s.op, ast.Mult) for s in sides]
    return isinstance(node.op, ast.Sub) and all(times)


def _subject(node: ast.AST) -> str:
    """The subject of the decision that a node makes; empty if it makes none."""
    if isinstance(node, ast.Call):
        called = next(_names(node.func), "")
        return "geometry" if isinstance(node.func, ast.Attribute) and called in PREDICATES else ""
    if not isinstance(node, ast.Compare):
        return ""
    if all(isinstance(o, ast.Is | ast.IsNot | ast.In | ast.NotIn) for o in node.ops):
        return ""
    if isinstance(node.ops[0], ast.Eq | ast.NotEq) and _zero(node.comparators[0]):
        return ""  # a test for zero or absence
    names = set(_names(node))
    if {name.lower() for name in names} & AUTHORITY:
        return "authority"
    if names & MEASURES or any(_product(part) for part in ast.walk(node)):
        return "geometry"
    return "measure" if any(name.endswith(SUFFIXES) for name in names) else ""


def places(root: Path = ROOT, parts: tuple[str, ...] = PARTS) -> list[Place]:
    """Every place in services and bridge that looks like a decision."""
    found = []
    for file in sorted(f for part in parts for f in (root / part).rglob("*.py")):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        todo: list[tuple[ast.AST, tuple[str, ...]]] = [(tree, ())]
        while todo:
            node, inside = todo.pop()
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                inside = (*inside, node.name)
            if subject := _subject(node):
                where = file.relative_to(root).as_posix()
                line = getattr(node, "lineno", 1)
                text = ast.unparse(node)
                found.append(Place(where, line, ".".join(inside), text, subject))
            todo += [(child, inside) for child in ast.iter_child_nodes(node)]
    return sorted(found, key=lambda p: (p.file, p.line, p.text))


def explanations(file: Path = FILE) -> list[Explanation]:
    """The entries of `decisions.json`; raises ValueError for an unknown kind, or without reason or functions."""
    found = []
    for row in json.loads(file.read_text(encoding="utf-8")):
        if row["kind"] not in KINDS or not row["reason"].strip() or not row["functions"]:
            raise ValueError(f"{file.name}: expected a kind of {', '.join(KINDS)}; got {row}")
        found.append(Explanation(row["file"], tuple(row["functions"]), row["kind"], row["reason"]))
    return found


def unexplained(root: Path = ROOT, file: Path = FILE, parts: tuple[str, ...] = PARTS) -> list[str]:
    """Places without an explanation, and explanations without a place."""
    seen, known = places(root, parts), explanations(file)
    wrong = [str(place) for place in seen if not any(e.covers(place) for e in known)]
    there = {place.name for place in seen}
    for explanation in known:
        if explanation.functions == ("*",) and any(map(explanation.covers, seen)):
            continue
        for function in explanation.functions:
            name = f"{explanation.file}:{function}"
            if name not in there:
                wrong.append(f"proofs/{file.name}: {name} decides nothing any more: remove it")
    return wrong


def counted() -> dict[str, int]:
    """The number of places of each kind."""
    seen, known = places(), explanations()
    counts = dict.fromkeys(KINDS, 0)
    for place in seen:
        kind = next((e.kind for e in known if e.covers(place)), None)
        if kind is not None:
            counts[kind] += 1
    return counts
