"""The command `cratous`: one line per command here, each command in its own module.

A module is imported only when its command runs, so that `cratous --help` is fast. Every error ends
as one message and an exit code: 0 all hold, 1 something is violated or no plan exists, 2 bad input,
3 something is unknown or excused; 70 is an internal error, and 128 or more gives the signal that
ended it.
"""

from __future__ import annotations

import gc
import importlib
import io
import json
import keyword
import sys
import traceback
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import click

from cratous import __version__
from cratous.services.cli.ending import end
from cratous.services.cli.stopping import Stopped, handlers_as_before, stop_behind, stoppable
from cratous.spec.errors import BadInput, CratousError, NoPlan
from cratous.spec.files.extras import told
from cratous.spec.files.printable import json_text, printable

INTERNAL_ERROR = 70
PACKAGE = f"{Path(__file__).parents[2]}/"
"""Prefix of the product's modules in tracebacks."""
COMMANDS = {
    "run": "Plan, prove, fly, monitor and certify a mission.",
    "demo": "Fly an example that ships with the product.",
    "campaign": "Fly and judge many runs, and count what holds.",
    "plan": "Plan a mission and check the plan; nothing flies.",
    "prove": "Prove the kernels and write the ledger (in a checkout).",
    "search-faults": "Find how broken designs of authority go wrong.",
    "replay-trace": "Play a trace of a broken design on the actors that fly.",
    "conform": "Run published vectors against the kernels and the wires.",
    "daa": "Alerts, bands and reasons for an encounter file.",
    "certify": "Judge a finished flight again from its log.",
    "assign": "Solve an assignment problem, with a certificate.",
    "certify-plan": "Check the certificate of an assignment.",
    "judge": "Judge a flight by a program that shares no code with it.",
    "monitor": "Watch a message log for violations of G1 to G5.",
    "log": "List, filter, follow, export, import and replay message logs.",
    "lmcp": "Read, write, explain and compare LMCP messages.",
    "uxas": "Run a UxAS configuration: services and bridges.",
    "wire": "Explain what was said over the CRATOUS bridge, line by line.",
    "icarous": "Avoid for one vehicle, over the CRATOUS bridge to UxAS.",
    "sim": "Simulate the aircraft of an AMASE scenario, and be its AMASE on the network.",
    "params": "List what ICAROUS and detect-and-avoid are set to for a mission.",
    "import": "Make a mission of flight plans, fences, traffic and parameters of ICAROUS.",
    "export": "Write a mission for other tools: AMASE, UxAS, GeoJSON, KML, ICAROUS.",
    "check": "Check mission files, algebra texts and requirements.",
    "serve": "Fly a mission, or replay one or two runs or a message log, in the browser.",
    "algebra": "Check, draw or enumerate a process-algebra text.",
    "warm": "Compile ahead what commands would compile when they need it.",
    "version": "Print the version.",
}

LASTING = frozenset({"campaign", "icarous", "serve", "sim", "uxas"})
"""Commands that may run for days."""


class LazyGroup(click.Group):
    """A group that imports its commands when they are called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        name = cmd_name.replace("-", "_")
        name += "_" * keyword.iskeyword(name)
        module = importlib.import_module(f"cratous.services.cli.{name}")
        command: click.Command = getattr(module, name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, message="%(prog)s %(version)s")
@click.option("--debug", is_flag=True, help="Show the traceback of an internal error.")
def cli(debug: bool) -> None:
    """Verified mission autonomy for teams of unmanned aircraft.

    Try it:  cratous demo

    Exit codes: 0 all requirements hold, 1 something is violated or no plan exists, 2 bad input,
    3 something is unknown or excused.
    """


def main(argv: list[str] | None = None) -> int:
    """Run a command line; returns the exit code and never raises."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    debug = "--debug" in arguments
    # the flag may stand anywhere, since users put it at the end
    arguments = [part for part in arguments if part != "--debug"]
    as_json = "--json" in arguments
    if argv is None:
        # most objects live until the end: collect garbage less often, and hardly ever in a process that ends soon
        lasts = LASTING.intersection(arguments[:1])
        gc.set_threshold(100_000 if lasts else 1_000_000, 10, 10)
    try:
        with handlers_as_before() if argv is not None else nullcontext(), stoppable(), told():
            result = cli.main(args=arguments, prog_name="cratous", standalone_mode=False)
        return result if isinstance(result, int) else 0
    except click.exceptions.Exit as done:
        return done.exit_code
    except Stopped as stop:
        return _stopped(stop)
    except SystemExit as done:
        return done.code if isinstance(done.code, int) else int(done.code is not None)
    except click.ClickException as error:
        return _usage(error, as_json)
    except (click.Abort, KeyboardInterrupt):
        click.echo("cratous: stopped", err=True)
        return 130
    except Exception as error:
        if debug and not isinstance(error, CratousError):
            raise
        behind = stop_behind(error)
        if behind is not None:
            return _stopped(behind, f"; on the way out: {type(error).__name__}: {error}")
        if isinstance(error, CratousError):
            return report_error(error, as_json)
        name = type(error).__name__
        said = printable(f"{name}: {error}")
        click.echo(f"cratous: internal error ({said}){_place(error)}", err=True)
        click.echo("This is a defect of CRATOUS. Add --debug to see where it is.", err=True)
        if as_json:
            click.echo(json.dumps({"error": f"internal error: {name}", "exit_code": 70}))
        return INTERNAL_ERROR


def program() -> None:
    """Run the command line of this process, and end the process."""
    end(main())


def _stopped(stop: Stopped, more: str = "") -> int:
    click.echo(f"cratous: stopped ({stop.name}){printable(more)}", err=True)
    return stop.exit_code


def _place(error: BaseException) -> str:
    """The position in the product's code where an error arose, so that it can be found if it is not
    reproducible.
    """
    frames = traceback.extract_tb(error.__traceback__)
    ours = [f for f in frames if f.filename.startswith(PACKAGE)]
    return f" at {ours[-1].filename.removeprefix(PACKAGE)}:{ours[-1].lineno}" if ours else ""


def _usage(error: click.ClickException, as_json: bool) -> int:
    if as_json:
        click.echo(json.dumps({"error": error.format_message(), "exit_code": 2}))
    else:
        said = io.StringIO()
        error.show(said)
        click.echo(printable(said.getvalue(), keep="\n"), err=True, nl=False)
    return 2


def report_error(error: CratousError, as_json: bool) -> int:
    """Print an error once, as text or as JSON; returns its exit code."""
    if as_json:
        click.echo(json_text({**error_data(error), "exit_code": error.exit_code}))
        return error.exit_code
    notes = "".join(f" {note}" for note in getattr(error, "__notes__", ()))
    # BadInput and NoPlan may quote the user's text: their line breaks are not kept
    keep = "" if isinstance(error, (BadInput, NoPlan)) else "\n"
    click.echo(printable(f"cratous: {error}{notes}", keep), err=True)
    caret = getattr(error, "caret", None)
    if caret is not None:
        click.echo(caret(), err=True)
    for other in getattr(error, "problems", ())[1:]:
        click.echo(printable(f"  also: {other}"), err=True)
    return error.exit_code


def error_data(error: CratousError) -> dict[str, Any]:
    """An error as JSON data, without its exit code."""
    if isinstance(error, BadInput):
        return error.data()
    if isinstance(error, NoPlan):
        return {"error": "no plan exists", "reasons": list(error.reasons)}
    return {"error": str(error)}
