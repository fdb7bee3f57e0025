"""The process in which a mission is planned for the page: what to plan on its stdin, what comes of it on its
stdout.

Both are JSON, one object a line. When stdin ends, whoever started it is gone, and it ends too.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
from collections.abc import Callable
from typing import Any

from cratous.services.cli.stopping import Stopped, stoppable
from cratous.spec.errors import BadInput, CratousError
from cratous.spec.files.printable import json_text

Tell = Callable[[dict[str, Any]], None]


def main() -> int:
    """Plan, then say why, until stdin ends; returns the exit code."""
    out, writing = os.dup(1), threading.Lock()
    os.dup2(2, 1)  # whatever else prints does not come between the lines

    def tell(what: dict[str, Any]) -> None:
        data = json_text(what).encode() + b"\n"
        with writing:
            while data:
                data = data[os.write(out, data) :]

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for who started this
    try:
        with stoppable():
            _plan(json.loads(sys.stdin.readline()), tell)
    except (Stopped, BrokenPipeError):
        return 1
    except CratousError as error:
        told = error.data() if isinstance(error, BadInput) else {"error": str(error)}
        tell({"state": "failed", "text": str(error), "error": told})
        return 2
    return 0


def _plan(asked: dict[str, Any], tell: Tell) -> None:
    from cratous.services.certify.verdicts import constraint_rows
    from cratous.services.loading.document import parse_document
    from cratous.services.loading.yaml_mission import loaded

    mission = loaded(parse_document(asked["text"], asked["where"]))
    tell({"text": "holding the code against its proofs"})

    from cratous.core import ledger
    from cratous.services.cli.job import (
        absent_lines,
        left_out_lines,
        new_bus,
        plan_and_check,
        plan_line,
        planning_told,
    )
    from cratous.services.logs.records import to_data
    from cratous.spec.mission.guarantees import exit_code

    standing = ledger.require(allow_unproved=asked["allow_unproved"])
    bus = new_bus()

    def at(text: str, done: int, of: int) -> None:
        tell({"text": f"{text}: {done} of {of}" if of else text})

    bus.tap(planning_told(at, len(mission.tasks)))
    made, checks = plan_and_check(mission, bus)
    code = exit_code([check.outcome for check in checks])
    tell(
        {
            "state": "planned",
            "text": plan_line(mission, made, checks),
            "plan": to_data(made),
            "constraints": constraint_rows(checks, "plan"),
            "notes": [*left_out_lines(made), *absent_lines(mission), *mission.notes],
            "proofs": standing.line,
            # no verdict of an unproved kernel is better than unknown
            "exit_code": 3 if standing.problems and code == 0 else code,
        }
    )
    _answer(mission, made, tell)


def _answer(mission: Any, made: Any, tell: Tell) -> None:
    """Say why a task is given to its vehicle, whenever that is asked."""
    from cratous.services.cli.plan import reasons_of, why_lines

    for line in sys.stdin:
        task = json.loads(line)["why"]
        if all(item.task_id != task for item in made.items):
            tell({"why": {str(task): [f"task {task} is not in the plan"]}})
            continue
        try:
            lines = why_lines(mission, made, task, reasons_of(mission, made, task))
        except CratousError as error:
            lines = [str(error)]
        tell({"why": {str(task): lines}})


if __name__ == "__main__":
    sys.exit(main())
