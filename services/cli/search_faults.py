"""`cratous search-faults`: finds faults in deliberately broken designs of authority."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import click

from cratous.spec.errors import BadInput
from cratous.spec.files.printable import json_text

SAFE, SAFE_HAND = "safe", "safe-certificate"
HAND_STEPS = 6
"""Maximum length of certificate traces: each step has more possibilities."""


@click.command()
@click.argument("names", nargs=-1, metavar="[NAME]...")
@click.option(
    "--steps", default=8, show_default=True, type=click.IntRange(1, 100), help="Longest trace."
)
@click.option(
    "--states",
    default=100_000,
    show_default=True,
    type=click.IntRange(1, 2_000_000),
    help="Give up after this many.",
)
@click.option(
    "--traces",
    type=click.Path(path_type=Path, file_okay=False),
    help="Write each trace into this folder, for `cratous replay-trace`.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, for machines.")
def search_faults(
    names: tuple[str, ...], steps: int, states: int, traces: Path | None, as_json: bool
) -> None:
    """Search broken designs of authority, and of the certificate in hand, for the shortest trace to a fault.

    The steps are the kernels that run: the gate, ICAROUS, the UxAS end, over a link that loses, repeats,
    delays and reorders, and on which SETMOD lines are forged; and the hand behind the gate, to which offers
    come late and twice. Each design named has one step replaced. `safe` and `safe-certificate` are the designs as
    they run. All of them without a name. The search is bounded: that nothing is
    found within the bound is no proof (`cratous prove --only 'system*'` has the proofs).

    Example: cratous search-faults no-acknowledgement safe

    Exit code: 0 each fault is found and the safe design shows none and returns control, 1 a safe design
    that is not or does not, 2 bad input, 3 a fault that is not found, or the bound of states is reached.
    """
    from cratous.proofs.system_search.authority import Design
    from cratous.proofs.system_search.breadth_first import search
    from cratous.proofs.system_search.certificate_faults import HAND_FAULTS
    from cratous.proofs.system_search.certificates import HandDesign
    from cratous.proofs.system_search.faults import FAULTS
    from cratous.services.cli.progress import waiting
    from cratous.services.trace_replay.files import Trace, place, write

    broken: dict[str, Any] = {**FAULTS, **HAND_FAULTS}
    says_of = {name: fault.says for name, fault in broken.items()}
    designs: dict[str, Any] = {SAFE: Design(), SAFE_HAND: HandDesign()}
    designs |= {name: fault.design for name, fault in broken.items()}
    known = [SAFE, *FAULTS, SAFE_HAND, *HAND_FAULTS]
    played = (SAFE, *FAULTS)
    for name in names:
        if name not in known:
            raise BadInput("no such design", item="NAME", expected=", ".join(known), got=name)
    files = {}
    if traces is not None:
        files = place(traces, names or known)
    rows: list[dict[str, Any]] = []
    code = 0
    for name in names or known:
        safe = name in (SAFE, SAFE_HAND)
        begun = time.monotonic()
        with waiting(
            f"searching the design {name}, {len(rows)} of {len(names or known)} done", as_json
        ):
            most = steps if name in played else min(steps, HAND_STEPS)
            found = search(designs[name], most, states)
        says = says_of.get(name, "the design as it runs")
        took = {"steps": most, "seconds": round(time.monotonic() - begun, 2)}
        texts = {"trace": [entry.text for entry in found.trace], "returned": found.returned}
        counts = {"wrong": found.wrong, "states": found.states, "complete": found.complete}
        rows.append({"name": name, "says": says, **texts, **counts, **took})
        entries = found.trace or found.back
        if name in files and entries:
            write(files[name], Trace(name, says, found.wrong, entries))
        if safe and (found.wrong or (found.complete and not found.returned)):
            code = 1
        elif bool(found.wrong) == safe or (safe and not found.complete):
            code = code or 3
    if as_json:
        click.echo(json_text({"designs": rows, "bounded": True, "exit_code": code}))
    else:
        for row in rows:
            _show(row)
    sys.exit(code)


def _show(row: dict[str, Any]) -> None:
    click.secho(f"{row['name']}: {row['says']}", bold=True)
    for number, text in enumerate(row["trace"], 1):
        click.echo(f"  {number}. {text}")
    if row["wrong"]:
        click.secho(f"  WRONG: {row['wrong']} ({row['states']} states)", fg="red")
        return
    seen = f"{row['states']} states, traces of up to {row['steps']} steps"
    if not row["complete"]:
        click.echo(f"  not decided: the bound of states was reached ({seen})")
        return
    lost = "a certificate" if row["name"] == SAFE_HAND else "control"
    back = f"{lost} that was lost returns" if row["returned"] else f"{lost} never returns"
    click.echo(f"  nothing wrong within the bound, which is no proof; {back} ({seen})")
