"""Signed results to tamper with: keys, statements that are signed again, reports that are edited whole."""

from __future__ import annotations

import base64
import copy
import json
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

from certify_tools import Run, read
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    PublicFormat,
)

from cratous.services.attestation.blame_check import blame_of
from cratous.services.attestation.dsse import signed
from cratous.services.attestation.findings import Subject
from cratous.services.attestation.names import VIEWS
from cratous.services.attestation.writing import Wanted, write_views
from cratous.services.certify.report import pages, report_text
from cratous.services.certify.verdicts import requirement_rows
from cratous.services.results.ownership import digest_of, manifest_text
from cratous.spec.mission.guarantees import Outcome, exit_code, worst

STATEMENT = "statement.dsse.json"
SEED = bytes(range(32))


def pem(key: Any) -> bytes:
    return bytes(key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption()))


def write_keys(folder: Path, name: str, key: Any) -> None:
    (folder / f"{name}.pem").write_bytes(pem(key))
    public = key.public_key().public_bytes(Encoding.PEM, PublicFormat.SubjectPublicKeyInfo)
    (folder / f"{name}.pub").write_bytes(public)


KEY = Ed25519PrivateKey.from_private_bytes(SEED)
OTHER = Ed25519PrivateKey.from_private_bytes(bytes(32))


def verify(run: Run, home: Path, *more: object, key: str = "own.pub") -> tuple[int, str, str]:
    words = ("--verify", home / "run", "-o", home / "views", "--public-key", home / key)
    return run("certify", *words, *more)


def statement_of(home: Path) -> dict[str, Any]:
    envelope = json.loads((home / "views" / STATEMENT).read_text())
    return dict(json.loads(base64.b64decode(envelope["payload"])))


def sign_again(home: Path, edit: Callable[[dict[str, Any]], None], key: Any = KEY) -> None:
    """A statement that was edited, or is on files that were, with a good signature."""
    data = statement_of(home)
    for one in data["subject"]:
        where, name = one["name"].split("/", 1)
        one["digest"]["sha256"] = digest_of(
            home / ("run" if where == "results" else "views") / name
        )
    edit(data)
    (home / "views" / STATEMENT).write_text(signed(json.dumps(data).encode(), key))


def flip(file: Path) -> None:
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(bytes(data))


def edit_envelope(home: Path, **entries: Any) -> None:
    file = home / "views" / STATEMENT
    file.write_text(json.dumps({**json.loads(file.read_text()), **entries}))


def edit_log(home: Path, statement: str) -> None:
    database = sqlite3.connect(home / "run" / "log.sqlite")
    with database:
        assert database.execute(statement).rowcount > 0
    database.close()


def edit_report(home: Path, **entries: Any) -> None:
    """The report edited, and all that is made from it; the signature is good."""
    folder = home / "run"
    report = {**read(folder), **entries}
    (folder / "report.json").write_text(report_text(report), encoding="utf-8")
    for name, text in pages(report).items():
        (folder / name).write_text(text, encoding="utf-8")
    names = sorted(entry.name for entry in folder.iterdir() if entry.name != "manifest.json")
    (folder / "manifest.json").write_text(manifest_text(folder, names))


def payload_with(home: Path, **predicate: Any) -> str:
    data = statement_of(home)
    data["predicate"].update(predicate)
    return base64.b64encode(json.dumps(data).encode()).decode()


def retell(home: Path, edit: Callable[[dict[str, Any]], None]) -> None:
    """A dishonest signer: rows are edited, and all that follows from them is made anew and signed."""
    report = copy.deepcopy(read(home / "run"))
    edit(report)
    report["requirements"] = requirement_rows(report["constraints"])
    outcomes = [Outcome(row["verdict"]) for row in report["requirements"]]
    verdicts = [row["verdict"] for row in report["constraints"]]
    report["counts"] = {str(outcome): verdicts.count(str(outcome)) for outcome in Outcome}
    report["verdict"], report["exit_code"] = str(worst(outcomes)), exit_code(outcomes)
    report["blame"] = blame_of(report)
    sign_whole(home, report)


def verify_edited(
    run: Run, home: Path, edit: Callable[[dict[str, Any]], None]
) -> tuple[int, str, str]:
    """What verifying says of a report that was edited, nothing else made to fit, and signed whole."""
    report = read(home / "run")
    edit(report)
    sign_whole(home, report)
    return verify(run, home)


def sign_whole(home: Path, report: dict[str, Any]) -> None:
    """A report as it is, with pages, views, and a good signature over all of it."""
    edit_report(home, **report)
    unchecked = tuple(statement_of(home)["predicate"]["not_checked"])
    write_views(Subject(report, unchecked), home / "run", home / "views", Wanted(VIEWS, None, KEY))
