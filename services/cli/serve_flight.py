"""The process in which `cratous serve MISSION` flies: commands on stdin, events on stdout."""

from __future__ import annotations

import functools
import json
import os
import shlex
import sys
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any

from cratous.services.cli.job import Settings, folder_name, run_mission
from cratous.services.cli.json_lines import end_main_thread, told_on_stdout
from cratous.services.cli.show import shown_path
from cratous.services.cli.stopping import Stopped, stoppable
from cratous.services.ground_station.direct_orders import Directed, DirectOrders
from cratous.services.ground_station.live_flight import LiveFlight, forward
from cratous.services.ground_station.live_session import NotObeyed
from cratous.services.ground_station.pace import Ended
from cratous.services.results.folder import results_folder
from cratous.services.results.names import COMMANDED_NAME
from cratous.spec.errors import BadInput, CratousError


def main(asked: dict[str, Any]) -> int:
    """Fly a mission; returns the exit code. asked: path, seed, out, and the fields of `Settings`;
    text: of the mission, None if it comes first on stdin; until_ms: time up to which it flies at
    full speed; commanded: whether it has operator commands.
    """
    send = told_on_stdout()

    def status(state: str, **more: Any) -> None:
        send({"status": {"state": state, **more}})

    with suppress(BrokenPipeError):  # the parent process is gone: nobody to inform
        try:
            with stoppable():
                if asked.get("text") is None:
                    asked = {**asked, **json.loads(sys.stdin.readline())}
                return _fly(asked, send, status)
        except (Stopped, Ended):
            status("stopped", text="The flight was stopped; no results were written.")
        except CratousError as error:
            told = error.data() if isinstance(error, BadInput) else {"error": str(error)}
            status("failed", text=str(error), error=told)
            return 2
    return 1


def _fly(asked: dict[str, Any], send: Any, status: Any) -> int:
    from cratous.services.loading.document import parse_document
    from cratous.services.loading.yaml_mission import loaded

    mission = loaded(parse_document(asked["text"], asked["path"]), asked["seed"])
    target = Path(asked["out"]) / folder_name(mission)
    read, write = os.pipe()
    orders = DirectOrders(asked["text"], functools.partial(_directed, asked["path"], asked["seed"]))
    live = LiveFlight(mission, send, write, orders)
    if "until_ms" in asked:
        live.pace.fly_to(asked["until_ms"])
    judged = forward(read, send)
    threading.Thread(target=_commands, args=(live,), daemon=True).start()

    def tell(text: str) -> None:
        if not text.startswith("\r") or "of flight" not in text:
            send({"status": {"text": text.strip()}})

    try:
        status("planning")
        with results_folder(target, tell) as folder:
            words = ["run", shown_path(target / COMMANDED_NAME), "--out", "again"]
            again = shlex.join(["cratous", *words, *asked["options"]])
            command = again if asked.get("commanded") else asked["command"]
            settings = Settings(asked["daa"], asked["allow_unproved"], command, again=again)
            report = run_mission(mission, folder, settings, tell, live)
            if asked.get("commanded") or orders.mission is not None:
                (folder / COMMANDED_NAME).write_text(orders.text, encoding="utf-8")
        live.tell()
    finally:
        live.end_judge()
        os.close(write)
        judged.join()
    live.verdicts(report)  # final verdicts: all of the judge's output has been sent before
    status("ended", text=f"{report['verdict'].upper()}: results in {target}", folder=str(target))
    return 0


def _directed(path: str, seed: int, text: str, at_ms: int, command: Any) -> Directed:
    from cratous.services.mission_editor.operator_commands import directed

    try:
        return directed(text, path, seed, at_ms, command)
    except NotObeyed as refused:
        raise BadInput(refused.why, where=path) from None


def _commands(live: LiveFlight) -> None:
    """Execute commands line by line; the flight ends with the input, for whatever reason.

    Stop is a signal, so that it also ends a search.
    """
    try:
        with suppress(BrokenPipeError):  # the sender is gone
            for line in sys.stdin:
                asked = json.loads(line)
                if asked.get("do") == "stop":
                    break
                live.command(asked)
    finally:
        end_main_thread()  # first, so that it does not interrupt any cleanup
        # the signal may arrive where Python drops exceptions, as within a fork
        live.pace.end()


if __name__ == "__main__":
    sys.exit(main(json.loads(sys.argv[1])))
