"""The state machine by which a vehicle takes off, drawn from the kernel that decides.

    python docs/tools/take_off_machine.py

prints the diagram for docs/guides/detect-and-avoid.md: `departure_step` is evaluated for each mode and each combination
of its inputs (whether UxAS is heard, the climb is permitted, the vehicle is off the ground, it is at the end of the
climb), and an arrow is drawn where the mode changes. The modes are those of the specification: `CRATOUS/TakeOff` of
spec/lmcp names them.
"""

from __future__ import annotations

from itertools import product
from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.take_off import Departure, departure_step
from cratous.spec.authority.take_off import BEGIN, BREAK_OFF, END, LEAVE, LIFT_OFF

WHY = {
    BEGIN: "permitted, and UxAS is heard",
    BREAK_OFF: "permitted no more, or UxAS is not heard",
    LIFT_OFF: "off the ground",
    END: "at the end of its way up",
    LEAVE: "permitted no more, or UxAS is not heard",
}
EITHER = (False, True)
NOW, BOUND = 10, 5


def modes() -> dict[int, str]:
    """The names of the modes, by number."""
    mode: Any = lmcp.new("TakeOffState").Mode
    return {int(one): one.name for one in type(mode)}


def block() -> str:
    """The diagram, as Mermaid text."""
    names, found = modes(), dict[tuple[int, int], set[str]]()
    for mode, heard, *told in product(names, EITHER, EITHER, EITHER, EITHER):
        step = departure_step(Departure(mode, 0), NOW if heard else 0, NOW, BOUND, *told)
        after = step.departure.mode
        if after != mode:
            found.setdefault((mode, after), set()).add(WHY[step.act])
    lines = ["stateDiagram-v2", "  [*] --> Standing: starts on the ground"]
    lines += ["  [*] --> Up: starts in the air"]
    for (mode, after), why in sorted(found.items()):
        lines.append(f"  {names[mode]} --> {names[after]}: {' / '.join(sorted(why))}")
    return "\n".join(("```mermaid", *lines, "```"))


if __name__ == "__main__":
    print(block())
