"""The state machine that a vehicle follows while UxAS is not heard, drawn from the kernel that decides.

    python docs/tools/link_loss_machine.py

prints the diagram for docs/guides/detect-and-avoid.md: `loss_step` is evaluated for each mode that it reaches and each
combination of its inputs (whether UxAS is heard, the chosen manoeuvre is permitted, the vehicle is at its end), and
an arrow is drawn where the mode changes. The modes, and which of them a mission may choose, are those of the
specification: `CRATOUS/WithoutLink` of spec/lmcp names them.
"""

from __future__ import annotations

from itertools import product
from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.link_loss import Loss, loss_step
from cratous.spec.authority.link_loss import FINAL, LANDED, LINKED, LOITER, OVER, may_be_chosen

EITHER = (False, True)
NOW, BOUND = 10, 5


def modes() -> dict[int, str]:
    """The names of the modes, by number."""
    mode: Any = lmcp.new("LinkLossState").Mode
    return {int(one): one.name for one in type(mode)}


def arrows() -> dict[tuple[int, int], set[str]]:
    """The conditions of each transition, by the pair of modes (from, to)."""
    found: dict[tuple[int, int], set[str]] = {}
    for chosen in filter(may_be_chosen, modes()):
        reached, to_ask = {LINKED}, [LINKED]
        while to_ask:
            mode = to_ask.pop()
            for heard, permitted, ended in product(EITHER, EITHER, EITHER):
                heard_ms = NOW if heard else 0
                step = loss_step(Loss(mode, 0), chosen, heard_ms, NOW, BOUND, permitted, ended)
                after = step.loss.mode
                if after != mode:
                    why = _why(after, chosen, heard)
                    found.setdefault((mode, after), set()).add(why)
                if after not in reached:
                    reached.add(after)
                    to_ask.append(after)
    return found


def _why(after: int, chosen: int, heard: bool) -> str:
    if after == LANDED:
        return "on the ground"
    if after == FINAL:
        return "at the gate, permitted to the ground"
    if heard:
        return "UxAS is heard"
    if after == OVER:
        return "flown to its end"
    if after == LOITER:
        return "chosen" if chosen == LOITER else "what is chosen is not permitted"
    return "chosen and permitted"


def block() -> str:
    """The diagram, as Mermaid text."""
    names, lines = modes(), ["stateDiagram-v2", "  [*] --> Linked"]
    for (mode, after), why in sorted(arrows().items()):
        lines.append(f"  {names[mode]} --> {names[after]}: {' / '.join(sorted(why))}")
    return "\n".join(("```mermaid", *lines, "```"))


if __name__ == "__main__":
    print(block())
