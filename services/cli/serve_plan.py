"""The planning process of the web page: requests for a plan, then for reasons, on stdin; results on stdout."""

from __future__ import annotations

import json
import sys
import threading
from contextlib import suppress
from queue import SimpleQueue
from typing import Any

from cratous.services.cli.json_lines import Tell, end_main_thread, told_on_stdout
from cratous.services.cli.stopping import Stopped, stoppable
from cratous.spec.errors import CratousError

Asked = SimpleQueue[dict[str, Any]]


def main() -> int:
    """Plan, then answer requests for reasons, until stdin ends; returns the exit code."""
    tell, asked = told_on_stdout(), Asked()
    with suppress(BrokenPipeError):  # the parent process is gone: nobody to inform
        try:
            with stoppable():
                threading.Thread(target=_listen, args=(asked,), daemon=True).start()
                _plan(asked, tell)
        except Stopped:
            pass
        except CratousError as error:
            tell({"state": "failed", "text": str(error)})
            return 2
    return 1


def _listen(asked: Asked) -> None:
    """Accept requests; a search is cancelled when its client disconnects."""
    try:
        for line in sys.stdin:
            asked.put(json.loads(line))
    finally:
        end_main_thread()


def _plan(asked: Asked, tell: Tell) -> None:
    from cratous.services.certify.verdicts import constraint_rows
    from cratous.services.loading.document import parse_document
    from cratous.services.loading.yaml_mission import loaded

    first = asked.get()
    mission = loaded(parse_document(first["text"], first["where"]))
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
    from cratous.services.mission.windows import windows
    from cratous.services.monitor.moving_plan import check_in_time
    from cratous.spec.mission.guarantees import exit_code

    standing = ledger.require(allow_unproved=first["allow_unproved"])
    bus = new_bus()

    def at(text: str, done: int, of: int) -> None:
        tell({"text": f"{text}: {done} of {of}" if of else text})

    bus.tap(planning_told(at, len(mission.tasks)))
    made, checks = plan_and_check(mission, bus)
    checks += check_in_time(mission, made)
    outcomes = [check.outcome for check in checks]
    tell(
        {
            "state": "planned",
            "text": plan_line(mission, made, checks),
            "plan": to_data(made),
            "windows": [window._asdict() for window in windows(made)],
            "constraints": constraint_rows(checks, "plan"),
            "notes": [*left_out_lines(made), *absent_lines(mission), *mission.notes],
            "proofs": standing.line,
            "exit_code": exit_code(outcomes, unproved=bool(standing.problems)),
        }
    )
    _answer(mission, made, asked, tell)


def _answer(mission: Any, made: Any, asked: Asked, tell: Tell) -> None:
    """Answer requests for why a task is assigned to its vehicle."""
    from cratous.services.cli.plan import reasons_of, why_lines

    while True:
        task = asked.get()["why"]
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
