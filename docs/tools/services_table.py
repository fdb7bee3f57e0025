"""The page `services.md`: service x message x attribute, each with the tests that show its effect.

Rows come from the registry: a service's subscriptions, the messages it sends, its attributes. A test declares its
subject with `@pytest.mark.shows("Service", "Message or attribute", ...)`: it sends the message or sets the attribute
(or receives what is sent), and asserts an effect. Marks are read from the tests' syntax trees; nothing is run.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from cratous.services.uxas.published_messages import SERVES
from cratous.services.uxas.registry import KINDS

TESTS = Path(__file__).resolve().parents[2] / "tests"
RECEIVED, KNOWN, SENT, ATTRIBUTE, UNUSED = (
    "receives",
    "knows",
    "sends",
    "attribute",
    "accepted, not used",
)


class Row(NamedTuple):
    """One message or attribute of a service, its default if it is an attribute, and the tests that show it."""

    service: str
    kind: str
    name: str
    default: str
    tests: tuple[str, ...]


def marks(folder: Path = TESTS) -> dict[tuple[str, str], list[str]]:
    """Tests by (service, name) that they show."""
    found: dict[tuple[str, str], list[str]] = {}
    for file in sorted(folder.rglob("test_*.py")):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        known = dict(_constants(tree))
        for node in tree.body:
            if not isinstance(node, ast.FunctionDef):
                continue
            for mark in node.decorator_list:
                if isinstance(mark, ast.Call) and ast.unparse(mark.func) == "pytest.mark.shows":
                    service, *names = [_text(argument, known) for argument in mark.args]
                    for name in names:
                        found.setdefault((service, name), []).append(f"{file.stem}: {node.name}")
    return found


def _constants(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Module-level names of string constants: `A = "x"` and `A, B = "x", "y"`."""
    for node in tree.body:
        if not isinstance(node, ast.Assign):
            continue
        pairs = [(node.targets[0], node.value)]
        if isinstance(node.value, ast.Tuple) and isinstance(node.targets[0], ast.Tuple):
            pairs = list(zip(node.targets[0].elts, node.value.elts, strict=True))
        for target, value in pairs:
            if isinstance(target, ast.Name) and isinstance(value, ast.Constant):
                yield target.id, str(value.value)


def _text(node: ast.expr, known: dict[str, str]) -> str:
    if isinstance(node, ast.Name):
        return known[node.id]
    assert isinstance(node, ast.Constant), ast.unparse(node)
    return str(node.value)


def rows() -> list[Row]:
    """All rows of the registry, in its order."""
    shown, made = marks(), []
    for service, (made_by, sends) in SERVES.items():
        kind = KINDS.get(service)
        names = [
            (RECEIVED, topic.rpartition(".")[2], "") for topic in getattr(made_by, "subscribes", ())
        ]
        names += [(KNOWN, name, "") for name in getattr(made_by, "knows", ())]
        names += [(SENT, name, "") for name in sends]
        for name, attribute in (kind.attributes if kind else {}).items():
            default = "" if attribute.default is None else str(attribute.default)
            sort = UNUSED if kind and name in kind.ignored else ATTRIBUTE
            names.append((sort, name, default))
        for sort, name, default in dict.fromkeys(names):
            tests = tuple(dict.fromkeys(shown.get((service, name), ())))
            made.append(Row(service, sort, name, default, tests))
    return made


def strays() -> list[str]:
    """Marks without a row."""
    known = {(row.service, row.name) for row in rows()}
    return [f"{service}: {name}" for service, name in marks() if (service, name) not in known]


def untested() -> list[str]:
    """Rows without a test, except attributes that are accepted and not used."""
    return [f"{r.service}: {r.kind} {r.name}" for r in rows() if not r.tests and r.kind != UNUSED]


def document() -> str:
    """The table as a page."""
    lines = [
        "# Services under test",
        "",
        "Generated from the registry of services and the tests by `make docs`; do not edit. A row",
        "stands here with the tests that send the message or set the attribute (or receive what is",
        "sent) and assert an effect; a row without one fails the suite. How services are configured",
        "is in [uxas.md](../guides/uxas.md). A subscription to a base type (Task, EntityState,",
        "EntityConfiguration, AbstractZone) is one to all of its kinds.",
    ]
    last = ""
    for row in rows():
        if row.service != last:
            lines += [
                "",
                f"## {row.service}",
                "| | name | default | shown by |",
                "|---|---|---|---|",
            ]
            last = row.service
        tests = "<br>".join(f"`{test}`" for test in row.tests)
        lines.append(f"| {row.kind} | `{row.name}` | {row.default} | {tests or '-'} |")
    return "\n".join(lines) + "\n"
