"""Signed statements: what is verified, and that every tampering is refused and named."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from certify_tools import Run, read

pytest.importorskip("cryptography", reason="the extra `sign` is not installed")

from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from cryptography.hazmat.primitives.asymmetric.x25519 import X25519PrivateKey
from signing import (
    KEY,
    SEED,
    STATEMENT,
    edit_envelope,
    edit_log,
    edit_report,
    flip,
    payload_with,
    sign_again,
    statement_of,
    verify,
    write_keys,
)

from cratous.services.attestation.dsse import opened, pre_authentication_encoding, signed


def a_verdict_is_turned(home: Path) -> None:
    """A dishonest signer: the report says that well clear was lost, and everything else follows."""
    report = read(home / "run")
    for row in report["constraints"]:
        if row["requirement"] == "G2":
            row["verdict"] = "violated"
    for row in report["requirements"]:
        if row["requirement"] == "G2":
            row["verdict"] = "violated"
    number = sum(row["verdict"] == "violated" for row in report["constraints"])
    counts = {**report["counts"], "violated": number, "holds": report["counts"]["holds"] - number}
    edit_report(
        home, constraints=report["constraints"], requirements=report["requirements"],
        verdict="violated", exit_code=1, counts=counts,
    )  # fmt: skip
    claim = {"verdict": "violated", "exit_code": 1, "counts": counts}
    sign_again(home, lambda data: data["predicate"].update(claim))


def summary_is_better_than_its_rows(home: Path) -> None:
    report = read(home / "run")
    report["constraints"][0]["verdict"] = "unknown"
    edit_report(home, constraints=report["constraints"])
    sign_again(home, lambda data: None)


def drop(name: str) -> Callable[[dict[str, Any]], None]:
    def edit(data: dict[str, Any]) -> None:
        data["subject"] = [one for one in data["subject"] if one["name"] != name]

    return edit


TAMPERINGS: dict[str, tuple[Callable[[Path], object], str]] = {
    "a bit of the report": (lambda h: flip(h / "run/report.json"), "results/report.json: SHA-256"),
    "a bit of the page": (lambda h: flip(h / "run/report.html"), "results/report.html: SHA-256"),
    "a message of the log": (
        lambda h: edit_log(h, "UPDATE messages SET time_ms = time_ms + 1 WHERE seq = 100"),
        "results/log.sqlite: SHA-256",
    ),
    "a log that is cut": (
        lambda h: os.truncate(h / "run/log.sqlite", 100_000), "results/log.sqlite: SHA-256",
    ),
    "a file beside the log": (
        lambda h: (h / "run/log.sqlite-wal").write_bytes(b"x"), "results/log.sqlite-wal: SQLite",
    ),
    "a certificate": (
        lambda h: flip(h / "run/certificate.json"), "results/certificate.json: SHA-256",
    ),
    "a failure in JUnit": (
        lambda h: (h / "views/junit.xml").write_text("<testsuites/>"), "views/junit.xml: SHA-256",
    ),
    "a finding in SARIF": (lambda h: flip(h / "views/report.sarif"), "views/report.sarif: SHA-256"),
    "a cell of the table": (
        lambda h: flip(h / "views/constraints.csv"), "views/constraints.csv: SHA-256",
    ),
    "a view that is gone": (
        lambda h: (h / "views/report.sarif").unlink(), "views/report.sarif: SHA-256",
    ),
    "the verdict in the statement": (
        lambda h: edit_envelope(h, payload=payload_with(h, verdict="violated")),
        f"{STATEMENT}: no signature of it is one by this key",
    ),
    "the payload type": (
        lambda h: edit_envelope(h, payloadType="text/plain"), f"{STATEMENT}: its payload type",
    ),
    "a signature that is gone": (
        lambda h: edit_envelope(h, signatures=[]), f"{STATEMENT}: it has no signature",
    ),
    "another signer": (
        lambda h: sign_again(h, lambda d: None, Ed25519PrivateKey.from_private_bytes(bytes(32))),
        f"{STATEMENT}: no signature of it is one by this key",
    ),
    "no envelope": (
        lambda h: (h / "views" / STATEMENT).write_text("[]"), f"{STATEMENT}: not a DSSE envelope",
    ),
    "signed without the log": (
        lambda h: sign_again(h, drop("results/log.sqlite")),
        "results/log.sqlite: the statement does not cover it",
    ),
    "signed without a view": (
        lambda h: sign_again(h, drop("views/junit.xml")),
        "views/junit.xml: the statement does not cover it",
    ),
    "signed with a file elsewhere": (
        lambda h: sign_again(h, lambda d: d["subject"][0].update(name="results/../../x")),
        f"{STATEMENT}: a subject is no file of results or views",
    ),
    "signed with another ledger": (
        lambda h: sign_again(h, lambda d: d["predicate"]["ledger"].update(seal="0" * 64)),
        f"{STATEMENT}: ledger is not that of report.json",
    ),
    "signed with a summary that its rows do not give": (
        summary_is_better_than_its_rows, "report.json: G1 is holds, its rows unknown",
    ),
    "signed against the evidence": (a_verdict_is_turned, "judge holds, monitor violated"),
    "signed out of the schema": (
        lambda h: (edit_report(h, approved=True), sign_again(h, lambda d: None)),
        "report.json, by its schema: report: Additional properties",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", TAMPERINGS)
def test_every_tampering_is_refused_and_named(run: Run, home: Path, case: str) -> None:
    edit, said = TAMPERINGS[case]
    edit(home)
    code, out, err = verify(run, home)
    assert code == 1
    assert f"refused: {said}" in err or (said in err and "refused: " in err), err
    assert "verified" not in out
    data = json.loads(verify(run, home, "--json")[1])
    assert (data["verified"], data["exit_code"]) == (False, 1)
    assert any(said in line for line in data["refused"])


def test_what_was_signed_is_verified(run: Run, home: Path, flown: Path) -> None:
    report = read(flown)
    code, out, err = verify(run, home)
    assert (code, err) == (report["exit_code"], "")
    flight = sum(row["source"] == "flight" for row in report["constraints"])
    assert f"{flight} of {flight} verdicts on the flight by the judge" in out
    assert "the report says HOLDS; verified: HOLDS; exit code 0" in out
    for what in (
        "report.sarif: whether its lines of the mission file are right", "margins, times, notes",
        "verdicts on the plan (cratous certify", "certificate.json (cratous certify-plan",
        "proofs of the kernels",
    ):  # fmt: skip
        assert any(line.startswith("not judged: ") and what in line for line in out.splitlines())
    predicate = statement_of(home)["predicate"]
    assert predicate["ledger"]["seal"] == report["proofs"]["seal"]
    assert predicate["log_digest"] == report["log"]["digest"]
    code, _, err = verify(run, home, key="other.pub")
    assert (code, "no signature of it is one by this key" in err) == (1, True)


def test_the_same_key_gives_the_same_bytes(
    run: Run, home: Path, judged: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From the environment as from a file; nothing of the key is printed."""
    before = {file.name: file.read_bytes() for file in (home / "views").iterdir()}
    text = (home / "own.pem").read_text()
    monkeypatch.setenv("CRATOUS_SIGNING_KEY", text)
    _, out, err = run("certify", home / "run", "-o", home / "views", "--sign")
    assert {file.name: file.read_bytes() for file in (home / "views").iterdir()} == before
    secret = text.splitlines()[1]
    assert secret not in out + err
    assert all(secret.encode() not in data and SEED not in data for data in before.values())


def test_keys_that_are_none(run: Run, home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CRATOUS_SIGNING_KEY", raising=False)
    secret = (home / "own.pem").read_text()
    (home / "half.pem").write_text(secret[: len(secret) // 2])
    write_keys(home, "kind", X25519PrivateKey.generate())
    for words, said in (
        ((), "there is no key to sign with"),
        (("--key", home / "nothing"), "no such file"),
        (("--key", home / "half.pem"), "not a key"),
        (("--key", home / "own.pub"), "not a key"),
        (("--key", home / "kind.pem"), "a key of another kind"),
    ):
        code, out, err = run("certify", home / "run", "--sign", *words)
        assert (code, said in err) == (2, True), err
        assert secret.splitlines()[1][:20] not in out + err
    for name, said in (("own.pem", "not a key"), ("kind.pub", "another kind"), ("no", "no such")):
        code, _, err = verify(run, home, key=name)
        assert (code, said in err) == (2, True), err
    assert not (home / "run" / "attestation").exists()


def test_options_that_go_against_each_other(run: Run, home: Path) -> None:
    for words in (
        ("--verify",), ("--public-key", "x"), ("--key", "x"), ("--mission", "x"),
        ("--verify", "--public-key", "x", "--junit"), ("--verify", "--public-key", "x", "--trace"),
    ):  # fmt: skip
        assert run("certify", home / "run", *words)[0] == 2, words
    shutil.rmtree(home / "views")
    code, _, err = verify(run, home)
    assert (code, "there is no such file" in err) == (2, True)


def test_neither_planner_nor_pilot_is_imported(home: Path) -> None:
    code = (
        "import sys\n"
        "from cratous.services.cli import main\n"
        "code = main(sys.argv[1:])\n"
        "print(*sorted(m for m in sys.modules if m.startswith('cratous.')))\n"
        "print(*[m for m in ('numba', 'z3', 'shapely', 'pyproj') if m in sys.modules])\n"
        "from cratous.core.kernel import REGISTRY\n"
        "print(len(REGISTRY), 'kernels')\n"
        "sys.exit(code)\n"
    )
    words = ["certify", "--verify", home / "run", "-o", home / "views", "--public-key", home / "own.pub"]  # fmt: skip
    done = subprocess.run(
        [sys.executable, "-c", code, *map(str, words)],
        capture_output=True, text=True, timeout=900, check=False,
    )  # fmt: skip
    assert "verified: signature" in done.stdout, done.stderr
    ours, engines, kernels = done.stdout.splitlines()[-3:]
    assert kernels == "0 kernels"
    parts = {".".join(name.split(".")[1:3]) for name in ours.split()}
    assert parts - {"judge." + p.split(".", 1)[-1] for p in parts if p.startswith("judge.")} <= {
        "judge", "spec", "spec.errors", "spec.files", "spec.mission", "services", "services.cli",
        "services.attestation", "services.certify", "services.results", "services.argument",
        # what makes the pages again, and the definitions that they draw
        "services.full_report", "spec.algebra", "spec.assignment", "spec.constraint_rows", "spec.schedule",
        # the texts of the assumptions, which its rows are held against
        "services.assumptions",
        # the ledger's records, for the argument, and what names the sources that they are of
        "core", "core.files", "core.kernel", "core.ledger", "core.readings",
    }, parts  # fmt: skip
    assert engines == ""


def test_the_envelope_is_that_of_the_standard() -> None:
    """The example of the DSSE protocol, and a signature that a statement of another type has not."""
    assert pre_authentication_encoding(b"hello world", "http://example.com/HelloWorld") == (
        b"DSSEv1 29 http://example.com/HelloWorld 11 hello world"
    )
    text = signed(b"{}", KEY)
    assert opened(text, KEY.public_key()) == (b"{}", "")
    assert opened(text.replace('"e30="', '"e30"'), KEY.public_key())[1] == "not a DSSE envelope"
