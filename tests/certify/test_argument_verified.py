"""`certify --verify` makes the argument again: what a signer changed in it, and what another ledger gives."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from certify_tools import Run, read

pytest.importorskip("cryptography", reason="the extra `sign` is not installed")

from signing import edit_report, sign_again, statement_of, verify

from cratous.core import ledger
from cratous.spec.errors import Refused

YAML, SVG = "argument.yaml", "argument.svg"
SILENCE = "system_silence_is_noticed_within_one_heartbeat"
OTHER = "f" * 64


def write(home: Path, name: str, edit: Callable[[str], str]) -> None:
    """A view that a signer edited, and signed as it is now."""
    file = home / "views" / name
    before = file.read_text("utf-8")
    after = edit(before)
    assert after != before
    file.write_text(after, encoding="utf-8")
    sign_again(home, lambda data: None)


def once(old: str, new: str) -> Callable[[str], str]:
    return lambda text: text.replace(old, new, 1)


def other_seal(text: str) -> str:
    return re.sub("(Held against the ledger with the seal )[0-9a-f]{64}", rf"\g<1>{OTHER}", text)


def without(home: Path, name: str) -> None:
    """A view taken away, and out of what is signed."""
    (home / "views" / name).unlink()
    data = statement_of(home)
    data["subject"] = [one for one in data["subject"] if one["name"] != f"views/{name}"]
    # `sign_again` starts from the statement as it stands, so this one is put there first
    from signing import KEY, STATEMENT

    from cratous.services.attestation.dsse import signed

    (home / "views" / STATEMENT).write_text(signed(json.dumps(data).encode(), KEY))


CHANGED: dict[str, tuple[str, Callable[[str], str]]] = {
    "a state in words": (YAML, once("premises satisfiable, ", "")),
    "a state as a class": (YAML, once("  classes:\n  - nothing-to-check\n", "")),
    "what supports a goal": (YAML, once("  - Sn-G1-row-1\n", "")),
    "a comment": (YAML, once("This is evidence, not certification credit.", "Certified.")),
    "a line more": (YAML, lambda text: text + "\n"),
    "an empty file": (YAML, lambda text: ""),
    "no ledger named": (YAML, once("# Held against the ledger", "# Held beyond the ledger")),
    "a text in a box": (SVG, once(">what is proved of", ">what is certain of")),
    "a colour of a box": (SVG, once("#f0f0f0", "#ffffff")),
    "a line of the drawing less": (SVG, lambda text: text[: text.rindex("<g ")] + "</svg>\n"),
    "a ledger in another place": (SVG, once("</svg>", f"<!-- {OTHER} --></svg>")),
}


@pytest.mark.parametrize("case", CHANGED)
def test_an_argument_that_the_report_does_not_give(run: Run, home: Path, case: str) -> None:
    name, edit = CHANGED[case]
    if case == "a text in a box":  # lines are broken by width: the words of some line
        text = (home / "views" / SVG).read_text("utf-8")
        words = re.findall(r">([a-z][^<>]* [^<>]*)</text>", text)
        edit = once(f">{words[len(words) // 2]}<", ">all is certain<")
    write(home, name, edit)
    code, out, err = verify(run, home)
    assert (code, "verified" in out) == (1, False)
    assert err == f"refused: views/{name}: it is not what report.json and the ledger give\n"


@pytest.mark.parametrize(("name", "other"), [(YAML, SVG), (SVG, YAML)])
def test_one_file_of_the_argument_alone(run: Run, home: Path, name: str, other: str) -> None:
    (home / "views" / name).rename(home / "kept")
    code, _, err = verify(run, home)
    assert (code, f"refused: views/{name}: SHA-256 signed" in err) == (1, True)
    (home / "kept").rename(home / "views" / name)
    without(home, name)
    code, out, err = verify(run, home)
    assert (code, "verified" in out) == (1, False)
    said = f"refused: views/{name}: {other} is written together with it, and it is not there"
    assert err == f"{said}\n"


def test_without_an_argument_nothing_is_said_of_one(run: Run, home: Path) -> None:
    for name in (YAML, SVG):
        without(home, name)
    code, out, err = verify(run, home)
    assert (code, err, "argument" in out) == (0, "", False)


def test_both_files_name_the_ledger(home: Path) -> None:
    seal = ledger.read()["seal"]
    assert re.fullmatch("[0-9a-f]{64}", seal)
    line = f"Held against the ledger with the seal {seal}"
    assert f"# {line}" in (home / "views" / YAML).read_text("utf-8").splitlines()
    assert f">{line}</text>" in (home / "views" / SVG).read_text("utf-8")


# ---- another ledger ------------------------------------------------------------------------------


def records(monkeypatch: pytest.MonkeyPatch, edit: Callable[[dict[str, Any]], object]) -> None:
    """The ledger of the verifying process is another one."""
    kept = copy.deepcopy(ledger.read())
    edit(kept)
    kept["seal"] = OTHER
    monkeypatch.setattr(ledger, "read", lambda: kept)


def test_another_ledger_is_named(run: Run, home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seal = ledger.read()["seal"]
    records(monkeypatch, lambda kept: kept["theorems"].pop(SILENCE))
    code, out, err = verify(run, home)
    assert (code, err) == (3, "")
    for name in (YAML, SVG):
        said = f"not decided: views/{name}: made with the ledger {seal[:16]}, the one here is {OTHER[:16]}"
        assert f"{said} and gives another" in out.splitlines()
    assert "the report says HOLDS; verified: UNKNOWN; exit code 3" in out
    data = json.loads(verify(run, home, "--json")[1])
    assert (data["verified"], data["verified_verdict"], data["exit_code"]) == (True, "unknown", 3)


def test_a_ledger_that_gives_the_same_argument_is_named(
    run: Run, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seal = ledger.read()["seal"]
    records(monkeypatch, lambda kept: None)
    code, out, err = verify(run, home)
    assert (code, err, "not decided" in out) == (0, "", False)
    for name in (YAML, SVG):
        said = f"not judged: views/{name}: made with the ledger {seal[:16]}; with the one here, {OTHER[:16]},"
        assert f"{said} it is the same" in out.splitlines()


def test_a_signer_who_names_a_ledger_of_his_own_proves_nothing(run: Run, home: Path) -> None:
    write(home, YAML, lambda text: other_seal(text).replace("premises satisfiable, ", "", 1))
    code, out, err = verify(run, home)
    assert (code, err) == (3, "")
    assert f"not decided: views/{YAML}: made with the ledger {OTHER[:16]}" in out
    assert "verified: UNKNOWN; exit code 3" in out
    assert f"views/{SVG}" not in out, "that one is as it should be"


def test_a_ledger_that_cannot_be_read_decides_nothing(
    run: Run, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken() -> dict[str, Any]:
        raise Refused("kernels/x.json was edited after the prover wrote it")

    monkeypatch.setattr(ledger, "read", broken)
    code, out, err = verify(run, home)
    assert (code, err) == (3, "")
    for name in (YAML, SVG):
        assert f"not decided: views/{name}: the ledger here cannot be read: kernels/x.json" in out


# ---- reports that are not ours -------------------------------------------------------------------


def lemma_of_itself(report: dict[str, Any]) -> None:
    report["proofs"]["theorems"][SILENCE]["lemmas"] = [SILENCE]


def modules_of_others(report: dict[str, Any]) -> None:
    """Names of kernels and definitions of which none may be imported, or looked for elsewhere."""
    kernels = report["proofs"]["kernels"]
    name = next(n for n, one in kernels.items() if one["kind"] == "kernel" and one["definition"])
    for number, (kernel, definition) in enumerate(
        [("antigravity.f", "a.b"), (".f", "a.b"), ("..", ".."), ("cratous.f", "../x.y"), ("", "")]
    ):
        kernels[kernel] = {**kernels[name], "definition": definition}
        report["constraints"][number]["kernels"] = [kernel]


@pytest.mark.parametrize("edit", [lemma_of_itself, modules_of_others])
def test_a_strange_report_ends_in_words(
    run: Run, home: Path, edit: Callable[[dict[str, Any]], None]
) -> None:
    import sys

    report = read(home / "run")
    edit(report)
    edit_report(home, **report)
    sign_again(home, lambda data: None)
    code, _, err = verify(run, home)
    assert code == 1
    for name in (YAML, SVG):
        assert f"refused: views/{name}: it is not what report.json and the ledger give" in err
    assert "antigravity" not in sys.modules


def test_a_report_that_gives_no_argument_is_refused(run: Run, home: Path) -> None:
    """Two kernels whose elements would have one id."""
    report = read(home / "run")
    kernels = report["proofs"]["kernels"]
    name = next(n for n, one in kernels.items() if one["kind"] == "kernel" and one["definition"])
    for number, kernel in enumerate(("k.same-name", "k.same.name", "k.other.name")):
        kernels[kernel] = {**kernels[name], "count": number + 1}
        report["constraints"][number]["kernels"] = [kernel]
    edit_report(home, **report)
    sign_again(home, lambda data: None)
    code, _, err = verify(run, home)
    assert (code, f"refused: views/{YAML}: report.json gives no argument: two elem" in err) == (
        1,
        True,
    ), err
