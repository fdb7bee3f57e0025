"""Text from outside is shown without what rewrites a screen, forges a line or runs in a table."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from cratous.services.certify.html import _environment
from cratous.services.cli import main
from cratous.services.cli.run import _show
from cratous.services.daa.tables import as_csv
from cratous.services.logs.entry import Entry
from cratous.services.logs.files import json_line, text_form
from cratous.services.uxas.logs import Logs
from cratous.spec.files.printable import cell, json_text, printable

BAD = "a\x1b[2J\r\nERROR forged\x9b1m\u202eb\u2028\ud800\x00\x7f\u2066"
HIDDEN = "\x1b\r\n\x9b\u202e\u2028\ud800\x00\x7f\u2066"


def _clean(text: str) -> bool:
    return not any(c in text.removesuffix("\n") for c in HIDDEN)


def test_every_character_that_hides_is_written_out() -> None:
    assert printable(BAD) == (
        "a\\x1b[2J\\r\\nERROR forged\\x9b1m\\u202eb\\u2028\\ud800\\x00\\x7f\\u2066"
    )
    assert printable("Zürich 北 \U0001f600 \\n") == "Zürich 北 \U0001f600 \\n"
    assert printable("a\nb\x1b", keep="\n") == "a\nb\\x1b"
    assert printable(Path("x\ny")) == "x\\ny"


def test_json_says_the_same_without_what_hides() -> None:
    for data in ({"a": BAD}, {"ü": "北"}):
        text = json_text(data)
        assert text.isprintable()
        assert json.loads(text) == data
    assert "北" in json_text("北")


@pytest.mark.parametrize(
    ("value", "wanted"),
    [
        ("=1+1", "'=1+1"), ("+cmd", "'+cmd"), ("-x", "'-x"), ("@a", "'@a"), ("\ta", "'\ta"),
        ("\r=a", "'\\r=a"), ("\n=a", "'\n=a"), ("-5", "-5"), ("+1.5e3", "+1.5e3"), (-5, -5),
        (-1.5, -1.5), ("a=1", "a=1"), ("", ""), (None, None), ("- 5", "'- 5"), ("-5\n", "'-5\n"),
    ],
)  # fmt: skip
def test_cells_that_a_spreadsheet_would_run(value: object, wanted: object) -> None:
    assert cell(value) == wanted


def test_tables_of_encounters_keep_numbers_and_neutralise_names() -> None:
    text = as_csv([{"id": "=cmd|x", "level": -1, "x_m": -2.5, "none": None}])
    assert list(csv.reader(text.splitlines()))[1] == ["'=cmd|x", "-1", "-2.5", ""]


def test_a_log_of_messages_is_one_line_each() -> None:
    entry = Entry(0, 0, BAD, f"t{BAD}", '{"Label":"\x9b\u202e"}', BAD)
    assert _clean(text_form(entry))
    line, _ = json_line(entry)
    assert _clean(line)
    assert json.loads(line)["source"] == BAD


def test_an_export_to_csv_neutralises_cells_and_names(tmp_path: Path) -> None:
    log = tmp_path / "in.jsonl"
    row = {
        "seq": 0, "time_ms": -1, "source": "=cmd", "topic": "@t",
        "body": {"=x": "+1+1", "Label": "-5", "n": -5, "b": "a\x1b"},
    }  # fmt: skip
    log.write_text(json.dumps(row) + "\n")
    assert main(["log", "export", str(log), "-o", str(tmp_path / "out.csv")]) in (0, 3)
    with (tmp_path / "out.csv").open(newline="") as lines:
        (found,) = csv.DictReader(lines)
    assert found["source"] == "'=cmd"
    assert found["time_ms"] == "-1"
    assert not any(key.startswith(("=", "@")) for key in found)
    assert not any(value.startswith(("=", "@", "+")) for value in found.values())
    assert "\x1b" not in "".join(found.values())


def test_peers_cannot_forge_lines_of_the_logger(tmp_path: Path) -> None:
    shown: list[str] = []
    log = Logs("DEBUG", "DEBUG", tmp_path, echo=shown.append)
    log("WARN", f"peer says {BAD}")
    log.close()
    assert all(_clean(line) for line in shown)
    assert log.path is not None
    text = log.path.read_text(encoding="utf-8")
    assert text.count("\n") == 1
    assert _clean(text)


def test_pages_show_no_hidden_characters_and_no_tags() -> None:
    page = (
        _environment()
        .from_string("<p>{{ a }}</p>{{ b|safe }}")
        .render(a=f"<script>{BAD}", b="<b>\n</b>")
    )
    assert "<script>" not in page
    assert "<b>\n</b>" in page
    assert not any(c in page for c in HIDDEN if c != "\n")


@pytest.mark.parametrize(
    "arguments",
    [
        ["plan", "no\x1b[2J\nsuch\u202e.yaml"],
        ["assign", "no\x1b[2J\nsuch.json"],
        ["certify-plan", "no\x1b[2J\nsuch.json"],
        ["conform", "polygon", "no\x1b[2J\nsuch.jsonl"],
        ["conform", "no\x1b[2J\nsuch", "x"],
        ["lmcp", "decode", "no\x1b[2J\nsuch.bin"],
        ["log", "list", "no\x1b[2J\nsuch.sqlite"],
        ["daa", "bands", "no\x1b[2J\nsuch.daa"],
        ["algebra", "check", "-f", "no\x1b[2J\nsuch.txt"],
        ["algebra", "check", "p1 \x1b[2J \x9b"],
        ["plan", "no\udcffsuch.yaml"],
        ["uxas", "-cfgPath", "no\x1b[2Jsuch.xml"],
        ["plan", "x", "--no\x1bsuch"],
        ["no\x1bsuch"],
    ],
)
@pytest.mark.parametrize("as_json", [False, True])
def test_errors_show_no_hidden_characters(
    arguments: list[str], as_json: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    if as_json and arguments[0] in ("lmcp", "uxas"):
        pytest.skip("a command without --json")
    assert main([*arguments, *(["--json"] if as_json else [])]) == 2
    said = capsys.readouterr()
    text = said.out + said.err
    assert text.strip()
    assert not any(c in text for c in "\x1b\x9b\u202e\udcff")
    assert not any(line.startswith("such") for line in text.splitlines())


def test_messages_of_a_peer_are_shown_without_what_hides(tmp_path: Path) -> None:
    log = tmp_path / "in.jsonl"
    row = {
        "seq": 0,
        "time_ms": 0,
        "source": "a\x1b[2J\nb",
        "topic": "t\u202e",
        "body": {"x": "\x9b"},
    }
    log.write_text(json.dumps(row) + "\n")
    from cratous.services.cli.log import log as command

    for options in ([], ["--json"]):
        result = CliRunner().invoke(command, ["filter", str(log), *options])
        assert result.stdout.count("\n") == 1
        assert _clean(result.stdout)


def test_the_summary_of_a_run_shows_no_hidden_characters(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    served = {"task": 1, "vehicle": 2, "phase": "Failed", "time_ms": 0, "served": 0.0, "note": BAD}
    change = {"time_ms": 0, "what": BAD, "consequence": BAD}
    flight = {"served": [served], "takeovers": [], "outcome": "failed", "end_ms": 0}
    flight["changes"] = [change]
    broken = {"name": "clock", "text": "t", "state": "broken", "since_ms": 0, "note": BAD}
    broken |= {"guarantees": ["G5"], "lost": "l", "stands": "s"}
    report = {"requirements": [], "flight": flight, "verdict": "violated", "exit_code": 1}
    report["command"] = "cratous run --processes"
    blamed = {"requirement": "G5", "item": BAD, "verdict": "violated", "time_ms": 0}
    blamed |= {"command": [], "ways_out": [], "broken_first": None, "not_observed": [BAD]}
    report |= {"log": {"digest": "0"}, "assumptions": [broken], "blame": [blamed]}
    _show(report, tmp_path / "a\x1b[2J")
    shown = capsys.readouterr().out
    assert "forged" in shown
    assert not any(c in shown for c in HIDDEN if c != "\n")
