"""`cratous wire`: explains recorded CRATOUS bridge traffic line by line."""

from __future__ import annotations

from pathlib import Path

import click

EXAMPLES = """
\b
Examples:
  tcpdump -i lo -w flight.pcap port 5557
  cratous wire explain flight.pcap
  cratous wire explain session.jsonl
"""


@click.group(epilog=EXAMPLES)
def wire() -> None:
    """Explain what was said over the CRATOUS bridge."""


@wire.command(epilog=EXAMPLES)
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--raw", is_flag=True, help="Print each line as it came, too.")
def explain(file: Path, raw: bool) -> int:
    """Tell a capture line by line: when, from whom, and what each line says.

    FILE is a pcap file, a recorded session (JSON lines), or text, a line of the protocol each. Lines of all dialects, packets and
    datagrams of v2 are told; whether those are authentic is not looked at, since that takes the connection's keys.

    Exit codes: 0 all lines are right, 2 something is wrong, or nothing is there.
    """
    from cratous.bridge.text_protocol.captures import read
    from cratous.bridge.text_protocol.explanation import told
    from cratous.spec.files.limits import MESSAGES_BYTES
    from cratous.spec.files.printable import printable
    from cratous.spec.files.text_file import bytes_of

    good, wrong = 0, 0
    for at_s, who, text, missing in read(bytes_of(file, MESSAGES_BYTES), str(file)):
        lost = f"MISSING: {missing} bytes were not captured"
        right, words = (False, lost) if missing else told(text)
        good, wrong = good + right, wrong + (not right)
        when = "" if at_s is None else f"{at_s:10.3f} s  "
        click.echo(printable(f"{when}{who + '  ' if who else ''}{words}"))
        if raw:
            click.echo(printable(f"    {text.decode('ascii', 'backslashreplace')}"))
    if wrong or not good:
        click.echo(f"cratous: {good} lines right, {wrong} wrong", err=True)
    return 2 if wrong or not good else 0
