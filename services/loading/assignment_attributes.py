"""Attributes of the AssignmentTreeBranchBoundService: those of UxAS, a deadline and the semantics.

| attribute | default | meaning |
|---|---|---|
| CostFunction | MINMAX | MINMAX, or CUMULATIVE |
| NumberNodesMaximum | none | nodes of the search; 0: the first leaf; negative: no limit |
| Deadline_ms | none | converted to a number of nodes by `NODES_PER_MS` |
| Semantics | time | `time`, or `order` as in UxAS |

A plan and its log must not depend on the speed of a machine, so a deadline is converted to a number
of nodes. Stopping at the first leaf, the default in UxAS (0), is done here only if requested.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cratous.spec.errors import BadInput
from cratous.spec.files.limits import integer_of

NODES_PER_MS = 100
"""Nodes per millisecond in searches for missions, on a slow core."""
NO_LIMIT = 100_000_000
KNOWN = ("CostFunction", "NumberNodesMaximum", "Deadline_ms", "Semantics")


@dataclass(frozen=True)
class Settings:
    """The values of the attributes; None where not given."""

    cost: str | None = None
    nodes: int | None = None
    semantics: str | None = None


def settings_of(attributes: Mapping[str, str], where: str = "") -> Settings:
    """The settings; BadInput for an invalid value. Other attributes are left to the caller."""
    written = attributes.get("CostFunction")
    cost = None if written is None else written.upper()
    if cost not in (None, "MINMAX", "CUMULATIVE"):
        raise _bad("CostFunction", "MINMAX or CUMULATIVE", written, where)
    semantics = attributes.get("Semantics")
    if semantics not in (None, "time", "order"):
        raise _bad("Semantics", "time or order", semantics, where)
    nodes = _whole(attributes, "NumberNodesMaximum", where)
    if nodes is not None and nodes < 0:
        nodes = NO_LIMIT
    patience = _whole(attributes, "Deadline_ms", where)
    if patience is not None:
        if patience <= 0:
            raise _bad("Deadline_ms", "more than 0", str(patience), where)
        nodes = min(NO_LIMIT if nodes is None else nodes, patience * NODES_PER_MS)
    return Settings(cost, nodes, semantics)


def _whole(attributes: Mapping[str, str], name: str, where: str) -> int | None:
    text = attributes.get(name)
    if text is None:
        return None
    number = integer_of(text, -(2**53), 2**53)
    if number is None:
        raise _bad(name, "a whole number", text[:40], where)
    return number


def _bad(name: str, expected: str, got: str | None, where: str) -> BadInput:
    item = f"AssignmentTreeBranchBoundService.{name}"
    what = "unknown cost function" if name == "CostFunction" else "not a value of this attribute"
    return BadInput(what, where=where, item=item, expected=expected, got=str(got))


def plans_live(communication: tuple[Mapping[str, str], str] | None) -> bool:
    """Whether ICAROUS may ask UxAS's planner for return paths, by the attributes of
    IcarousCommunicationService, if present.
    """
    text = "" if communication is None else communication[0].get("UseUxasRoutePlanner", "")
    return text.strip().lower() in ("true", "1")
