"""`cratous certify --mcap`: the messages of the log as a view that is signed, made again, and read as a log."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import pytest
from certify_tools import ROOT, Run, read

pytest.importorskip("cryptography", reason="the extra `sign` is not installed")
pytest.importorskip("mcap", reason="the extra `wires` is not installed")

from signing import sign_again, verify

from cratous.services.attestation import rebuilt_pages as module
from cratous.services.attestation.names import WRITTEN_BY
from cratous.services.logs.source import open_log

OTHER = "views/run.mcap: it is not what log.sqlite gives"


def test_it_is_signed_made_again_and_read_as_a_log(
    run: Run, home: Path, judged: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = ["certify", home / "run", "-o", home / "views", "--mcap", "--sign", "--key"]
    for old in (home / "views").iterdir():
        old.unlink()
    code, out, _ = run(*words, home / "own.pem")
    assert code == read(home / "run")["exit_code"]
    file = home / "views" / "run.mcap"
    assert f"written: {file}" in out
    with open_log(file) as made, open_log(home / "run" / "log.sqlite") as log:
        assert [(e.seq, e.time_ms, e.source, e.topic, e.body) for e in made.entries()] == [
            (e.seq, e.time_ms, e.source, e.topic, e.body) for e in log.entries()
        ]
    code, out, err = verify(run, home)
    assert (err, "run.mcap" in out) == ("", False), "made again, and the same"
    file.write_bytes(file.read_bytes() + b"\0")
    sign_again(home, lambda _statement: None)
    assert verify(run, home)[::2] == (1, f"refused: {OTHER}\n")
    # another version of a package may write other bytes
    monkeypatch.setattr(module, "version", lambda _package: "0")
    code, out, err = verify(run, home)
    assert (code == 1, err) == (False, "")
    assert "not judged: views/run.mcap: mcap 0, where 1.6.0 is asked for, makes another one" in out


def test_without_the_extra_it_is_refused_before_anything_is_judged(
    run: Run, flown: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == "mcap"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "mcap", None)
    code, out, err = run("certify", flown, "-o", tmp_path / "views", "--mcap")
    assert (code, out, (tmp_path / "views").exists()) == (2, "", False)
    assert "pip install 'cratous[wires]'" in err


def test_the_versions_are_those_that_the_extras_name() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"][
        "optional-dependencies"
    ]
    asked = {line for names in extras.values() for line in names}
    for pairs in WRITTEN_BY.values():
        assert {f"{package}=={version}" for package, version in pairs} <= asked
