"""`certify --verify` judges requirements of the user's own again from text and log, and finds what a signer changed."""

from __future__ import annotations

import hashlib
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from certify_tools import ROOT, Run, read
from own_tools import TEXT, Edit, changed

from cratous.services.attestation.requirements_check import own_faults
from cratous.services.certify.requirements_judged_again import outcomes_of
from cratous.services.requirements.requirement_files import own_file
from cratous.spec.mission.guarantees import exit_code, worst


@pytest.fixture(scope="module")
def signed_own(with_own: Path, signed_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    import signing

    home = tmp_path_factory.mktemp("signed-own")
    shutil.copytree(signed_run, home, dirs_exist_ok=True)
    shutil.rmtree(home / "run")
    shutil.copytree(with_own, home / "run")
    signing.sign_whole(home, read(home / "run"))
    return home


@pytest.fixture
def own_home(signed_own: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(signed_own, tmp_path / "home"))


def test_verifying_makes_them_again_without_planner_and_pilot(signed_own: Path) -> None:
    code = (
        "import sys\nfrom cratous.services.cli import main\ncode = main(sys.argv[1:])\n"
        "print(*sorted(m for m in sys.modules if m.startswith('cratous.')))\n"
        "print(*[m for m in ('numba', 'z3', 'shapely', 'pyproj') if m in sys.modules])\nsys.exit(code)\n"
    )
    words = ["--verify", signed_own / "run", "-o", signed_own / "views", "--public-key", signed_own / "own.pub"]  # fmt: skip
    done = subprocess.run(
        [sys.executable, "-c", code, "certify", *map(str, words)],
        capture_output=True, text=True, timeout=900, check=False, cwd=ROOT,
    )  # fmt: skip
    *said, ours, engines = done.stdout.splitlines()
    assert any("5 requirements of the user's own from the log" in line for line in said), (
        done.stderr
    )
    assert done.returncode == 1
    assert engines == ""
    parts = {".".join(name.split(".")[1:3]) for name in ours.split()}
    assert not parts & {
        f"services.{name}" for name in ("planning", "flight", "monitor", "pipeline", "icarous", "avoidance")
    }  # fmt: skip
    assert {p for p in parts if p.startswith("core.")} <= {
        "core.files", "core.kernel", "core.ledger", "core.readings", "core.requirements",
    }  # fmt: skip


def row_left_out(report: dict[str, Any]) -> None:
    del report["own"]["requirements"][1]


def invented(report: dict[str, Any]) -> None:
    there = report["own"]["requirements"]
    there.append({**there[0], "requirement": "NEW"})


def blamed(report: dict[str, Any]) -> None:
    report["own"]["requirements"][1]["blame"]["command"][0]["side"] = "ICAROUS"


def other_text(report: dict[str, Any]) -> None:
    """The file says something else, and its digest is right."""
    (file,) = report["own"]["files"]
    file["text"] = TEXT.replace("20 deg", "60 deg")
    file["sha256"] = hashlib.sha256(file["text"].encode()).hexdigest()


def not_of_the_language(report: dict[str, Any]) -> None:
    (file,) = report["own"]["files"]
    file["text"] = "nothing"
    file["sha256"] = hashlib.sha256(b"nothing").hexdigest()


HALF = TEXT + "#\ud800"


def import_of(text: str, name: str = "export.json") -> dict[str, str]:
    return {"file": name, "sha256": hashlib.sha256(text.encode()).hexdigest(), "text": text}


def id_taken(report: dict[str, Any]) -> None:
    (file,) = report["own"]["files"]
    file["text"] = TEXT.replace("BANK", "G1")
    file["sha256"] = hashlib.sha256(file["text"].encode()).hexdigest()


TAMPERED: dict[str, tuple[Edit, str]] = {
    "a row left out": (row_left_out, "own lacks the requirement BANK"),
    "renamed": (changed("requirement", "TURN"), "own lacks the requirement BANK"),
    "invented": (invented, "own has a requirement that is in no file: NEW"),
    "a verdict": (changed("verdict", "holds"), 'own BANK.verdict: written "holds", found "violated"'),
    "a text": (changed("text", "requirement BANK: roll_1 <= 60 deg"), "own BANK.text: written"),
    "a margin": (changed("margin", 1.0), "own BANK.margin: written 1.0, found -"),
    "its unit": (changed("unit", "rad"), "own BANK.unit"),
    "the instant": (changed("time_ms", 5), "own BANK.time_ms"),
    "the checks": (changed("checks", 5), "own BANK.checks"),
    "the blame": (blamed, "own BANK.blame.command[0].side"),
    "a file's digest": (
        lambda r: r["own"]["files"][0].update(sha256="0" * 64), "own: own.req: its text has another digest",
    ),
    "a file's text": (other_text, "own BANK.verdict: written"),
    "a file that says nothing": (not_of_the_language, "own: own.req, line 1"),
    "an export": (
        lambda r: r["own"]["files"][0]["imports"][0].update(text="[]"), "own: export.json: its text has another digest",
    ),
    "an import twice": (
        lambda r: r["own"]["files"][0]["imports"].insert(0, import_of("nonsense")),
        "own: own.req: its imports are others than it takes",
    ),
    "an import that it does not take": (
        lambda r: r["own"]["files"][0]["imports"].append(import_of("[]", "z.json")),
        "own: own.req: its imports are others than it takes",
    ),
    "two files of one name": (
        lambda r: r["own"]["files"].append(r["own"]["files"][0]), "own: own.req: these files cannot be judged together",
    ),
    "an id of the guarantees": (id_taken, "own: own.req: G1: the id is taken"),
    "half a character": (
        lambda r: r["own"]["files"][0].update(text=HALF, sha256=hashlib.sha256(HALF.encode("utf-8", "surrogatepass")).hexdigest()),
        "own: own.files: these are no files",
    ),
    "the order": (
        lambda r: r["own"]["requirements"].reverse(), "own has its requirements in another order",
    ),
    "a finding": (lambda r: r["own"]["findings"].clear(), "own.findings: written 0 entries, found 1"),
}  # fmt: skip


@pytest.mark.parametrize("name", TAMPERED)
def test_what_a_signer_tampers_with_is_found(with_own: Path, name: str) -> None:
    edit, said = TAMPERED[name]
    report = read(with_own)
    assert own_faults(report, {}, with_own / "log.sqlite") == ([], 5)
    edit(report)
    found, _ = own_faults(report, {}, with_own / "log.sqlite")
    assert any(line.startswith(f"report.json: {said}") for line in found), found


def test_all_of_them_left_out_of_a_flight_with_them_is_found(with_own: Path, own: Path) -> None:
    report = read(with_own)
    del report["own"]
    assert own_faults(report, {}, with_own / "log.sqlite") == ([], 0)
    assert own_faults(report, {"own": []}, with_own / "log.sqlite") == ([], 0)
    named = {"own": [own_file(own, own.name).named]}
    ((line,), _) = own_faults(report, named, with_own / "log.sqlite")
    assert "own: the flight was flown with own.req (SHA-256 " in line


def test_what_was_made_to_fit_and_signed_is_refused(run: Run, own_home: Path) -> None:
    import signing

    report = read(own_home / "run")
    changed("verdict", "holds")(report)
    outcomes = outcomes_of(report)
    report |= {"verdict": str(worst(outcomes)), "exit_code": exit_code(outcomes)}
    signing.sign_whole(own_home, report)
    code, out, err = signing.verify(run, own_home)
    assert (code, "verified" in out) == (1, False)
    assert 'refused: report.json: own BANK.verdict: written "holds", found "violated"' in err
