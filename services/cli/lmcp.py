"""`cratous lmcp`: read, write, explain and compare LMCP messages and series."""

from __future__ import annotations

import dataclasses
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click

from cratous.bridge import envelope
from cratous.bridge.lmcp import describe as words
from cratous.bridge.lmcp import differences, enums, mdm, model, stored_forms, stubs, types
from cratous.bridge.lmcp import schema as schemas
from cratous.core.files.whole_file import write_atomically
from cratous.services.cli.show import say
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import MESSAGES_BYTES, at_most
from cratous.spec.files.printable import printable
from cratous.spec.files.text_file import bytes_of

EXAMPLES = """
\b
Examples:
  cratous lmcp decode capture.tcp.bin --to text
  cratous lmcp encode message.xml --to frames -o message.bin
  cratous lmcp describe AirVehicleState
  cratous lmcp diff CMASI newer/CMASI.xml
  cratous lmcp --mdm OURS.xml schema Buoy > buoy.schema.json
\b
FILE is a path or - for standard input. Its form is found out: LMCP messages, an envelope, sentinel
frames, hexadecimal of these, XML, JSON; gzipped or not.
"""


@click.group(epilog=EXAMPLES)
@click.option(
    "--mdm", "files", multiple=True, metavar="FILE", help="Also know the series of this MDM file."
)
def lmcp(files: tuple[str, ...]) -> None:
    """Read, write, explain and compare LMCP messages."""
    mdm.load(*files)


def _bytes(file: str) -> bytes:
    if file == "-":
        data = sys.stdin.buffer.read(MESSAGES_BYTES + 1)
        at_most(len(data), MESSAGES_BYTES, "the input is too long", "stdin")
        return data
    return bytes_of(Path(file), MESSAGES_BYTES)


def _form(command: Any) -> Any:
    return click.option(
        "--from", "form", type=click.Choice(("auto", *stored_forms.FORMS)), default="auto",
        show_default=True, help="Form of the input.",
    )(command)  # fmt: skip


def _all(found: Iterator[stored_forms.Found]) -> Iterator[stored_forms.Found]:
    """The messages as they are read; an error in the rest of the input becomes an item instead of an exception."""
    while True:
        try:
            yield next(found)
        except StopIteration:
            return
        except BadInput as err:
            yield stored_forms.Found(err.where, None, err)
            return


@lmcp.command(epilog=EXAMPLES)
@click.argument("file", nargs=-1, required=True)
@_form
@click.option(
    "--to", type=click.Choice(("json", "xml", "text")), default="json", show_default=True,
    help="JSON: one line for each message.",
)  # fmt: skip
@click.option("--envelope", "around", is_flag=True, help="Print address and attributes as well.")
def decode(file: tuple[str, ...], form: str, to: str, around: bool) -> int:
    """Print the messages of every FILE.

    A message that is wrong is reported with its place, and the others are printed all the same.

    Exit codes: 0 all messages were right, 2 something was wrong, or nothing was there.
    """
    good, wrong = 0, 0
    for name in file:
        for found in _all(stored_forms.read(_bytes(name), name, form)):
            if found.error is not None:
                wrong += 1
                click.echo(f"cratous: {found.error}", err=True)
                continue
            try:
                text = _text(found, to, around)
            except BadInput as err:  # an object that XML cannot represent
                wrong += 1
                say(f"cratous: {found.where}: {err}", err=True)
                continue
            good += 1
            click.echo(printable(text, keep="\n\t"))
    if wrong or not good:
        click.echo(f"cratous: {good} messages right, {wrong} wrong", err=True)
    return 2 if wrong or not good else 0


def _text(found: stored_forms.Found, to: str, around: bool) -> str:
    message = found.envelope if around else None
    if to == "json":
        text = stored_forms.write(found.object, "json").decode().rstrip("\n")
        if message is None:
            return text
        head = {"address": message.address}
        head |= zip(envelope.ATTRIBUTES, message.attributes, strict=True)
        return json.dumps(head, ensure_ascii=False)[:-1] + f', "message": {text}}}'
    body = (
        words.pretty(found.object)
        if to == "text"
        else stored_forms.write(found.object, "xml").decode().rstrip("\n")
    )
    if message is None:
        return body
    head_text = f"{message.address} {'|'.join(message.attributes)}"
    return f"{head_text}\n{body}" if to == "text" else f"<!-- {head_text} -->\n{body}"


@lmcp.command(epilog=EXAMPLES)
@click.argument("file", nargs=-1, required=True)
@_form
@click.option(
    "--to", type=click.Choice(stored_forms.OUTPUTS), default="binary", show_default=True,
    help="Form of the output.",
)  # fmt: skip
@click.option("-o", "--output", metavar="FILE", help="Where to write; standard output otherwise.")
@click.option("--address", default="", help="Address of envelopes; the message's type otherwise.")
@click.option("--group", default="", help="Source group in envelopes.")
@click.option("--entity", default=0, help="Source entity id in envelopes.")
@click.option("--service", default=0, help="Source service id in envelopes.")
def encode(
    file: tuple[str, ...], form: str, to: str, output: str | None, address: str, group: str,
    entity: int, service: int,
) -> None:  # fmt: skip
    """Write the messages of every FILE one behind the other; nothing if one of them is wrong."""
    around = envelope.AddressedMessage(
        address, envelope.LMCP, "", group, str(entity), str(service), b""
    )
    written = []
    for name in file:
        for found in stored_forms.read(_bytes(name), name, form):
            if found.error is not None:
                raise found.error
            written.append(stored_forms.write(found.object, to, around))
    if not written:
        raise BadInput("no message", where=" ".join(file))
    data = b"".join(written)
    if output:
        write_atomically(Path(output), data)
    else:
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()


@lmcp.command(epilog=EXAMPLES)
@click.argument("name", required=False)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, for machines.")
@click.option("--stubs", "as_stubs", is_flag=True, help="Print Python typing stubs of a series.")
def describe(name: str | None, as_json: bool, as_stubs: bool) -> None:
    """Explain NAME: a message type, an enum or a series. Without NAME: list the series.

    A type is named by `AirVehicleState`, `CMASI/AirVehicleState` or `afrl.cmasi.AirVehicleState`.
    """
    if as_stubs:
        click.echo(stubs.stub(_series(name or "")), nl=False)
        return
    if name is None or name in model.known():
        chosen = [model.load(s) for s in (model.known() if name is None else (name,))]
        if as_json:
            click.echo(json.dumps([_facts_of_series(s) for s in chosen], indent=1))
        elif name is None:
            for s in chosen:
                counts = f"{len(s.structs)} types, {len(s.enums)} enums"
                click.echo(f"{s.name:<9} version {s.version:<3} {s.namespace:<22} {counts}")
        else:
            _show_series(chosen[0])
        return
    series, short = _resolved(name)
    loaded = model.load(series)
    if short in loaded.enums:
        entries = loaded.enums[short]
        if as_json:
            click.echo(json.dumps({"enum": f"{series}/{short}", "entries": entries}))
            return
        click.echo(f"{loaded.full_name(short)}: enum of {series}")
        for entry, value in entries.items():
            click.echo(f"    {entry} = {value}")
        return
    cls = types[f"{series}/{short}"]
    heirs = [types[n].type_name for n in types if issubclass(types[n], cls) and types[n] is not cls]
    if as_json:
        facts = {
            "type": cls.type_name, "names": cls.all_names, "id": cls.type_id,
            "version": loaded.version, "extends": loaded.structs[short].extends or None,
            "extended_by": heirs, "fields": [dataclasses.asdict(f) for f in cls.fields],
        }  # fmt: skip
        click.echo(json.dumps(facts, indent=1))
        return
    click.echo(cls.__doc__)
    if heirs:
        click.echo(f"\nExtended by: {', '.join(heirs)}")


def _series(name: str) -> str:
    if name not in model.known():
        raise BadInput(
            "unknown message series", expected=" or ".join(model.known()), got=repr(name)
        )
    return name


def _resolved(name: str) -> tuple[str, str]:
    from difflib import get_close_matches

    try:
        return model.resolve(name)
    except BadInput as err:
        full = [*types, *enums]
        short = {n.rpartition(".")[2].lower(): n.rpartition(".")[2] for n in full}
        wanted = name.replace("/", ".").rpartition(".")[2].lower()
        near = [short[n] for n in get_close_matches(wanted, short, 3)]
        raise BadInput(err.what, item=name, expected=" or ".join(near) or err.expected) from None


def _facts_of_series(s: model.Series) -> dict[str, Any]:
    return {
        "series": s.name, "namespace": s.namespace, "version": s.version, "wire_id": s.wire_id,
        "types": {n: struct.id for n, struct in s.structs.items()}, "enums": s.enums,
    }  # fmt: skip


def _show_series(s: model.Series) -> None:
    click.echo(f"{s.name}: version {s.version}, {s.namespace}, wire id {s.wire_id}")
    for struct in s.structs.values():
        above = f" extends {struct.extends}" if struct.extends else ""
        click.echo(f"  {struct.id:>3} {struct.name}{above}")
    for name, entries in s.enums.items():
        click.echo(f"  enum {name}: {', '.join(entries)}")


@lmcp.command(epilog=EXAMPLES)
@click.argument("first")
@click.argument("second")
@click.option("--json", "as_json", is_flag=True, help="Print JSON, for machines.")
def diff(first: str, second: str, as_json: bool) -> int:
    """What differs between FIRST and SECOND: files of messages, or two series.

    A series is an MDM file, or the name of one that is known. Messages are compared in order.

    Exit codes: 0 nothing differs, 1 something differs, 2 bad input.
    """
    one, two = _series_of(first), _series_of(second)
    if (one is None) != (two is None):
        raise BadInput("a series and messages", expected="two series or two files of messages")
    if one is not None and two is not None:
        found = list(differences.of_series(one, two))
    else:
        sides = [
            [_right(f) for f in stored_forms.read(_bytes(name), name)] for name in (first, second)
        ]
        found = []
        for i in range(max(map(len, sides))):
            one_side, other = (side[i] if i < len(side) else None for side in sides)
            path = f"message {i + 1}" if max(map(len, sides)) > 1 else ""
            found += differences.of_objects(one_side, other, path)
    if as_json:
        rows = [dataclasses.asdict(d) for d in found]
        click.echo(json.dumps({"differences": rows, "exit_code": int(bool(found))}, indent=1))
    else:
        for difference in found:
            say(str(difference))
        click.echo(f"{len(found)} differences" if len(found) != 1 else "1 difference")
    return int(bool(found))


def _right(found: stored_forms.Found) -> Any:
    if found.error is not None:
        raise found.error
    return found.object


def _series_of(name: str) -> model.Series | None:
    if name in model.known() and not Path(name).exists():
        return model.load(name)
    data = _bytes(name) if name != "-" else b""
    if b"<MDM" not in data[:65536]:
        return None
    return model.from_dict(mdm.parse(data, name))


@lmcp.command(epilog=EXAMPLES)
@click.argument("name", nargs=-1)
@click.option("--indent", default=1, show_default=True, help="Blanks of indentation.")
def schema(name: tuple[str, ...], indent: int) -> None:
    """Print the JSON Schema of our JSON form: of the types NAME, or of all."""
    for one in name:
        _resolved(one)
    click.echo(json.dumps(schemas.schema(name), ensure_ascii=False, indent=indent))
