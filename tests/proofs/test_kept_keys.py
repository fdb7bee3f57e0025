"""The gate's kept keys: the same as those that are walked, and made anew after any difference."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cratous.core import ledger
from cratous.core.kernel.sources import ROOT, reached
from cratous.core.ledger import kept_keys
from cratous.core.ledger.key_parts import MISSING
from cratous.core.ledger.keys import Keys
from cratous.core.ledger.package_home import PRODUCT

DATA = ledger.read()
NAME = sorted(DATA["kernels"])[0]


@pytest.fixture(scope="module")
def entries() -> dict:
    """One kernel: its walk takes part of a second."""
    return {NAME: ledger.load_all()[NAME]}


@pytest.fixture(scope="module")
def rests(entries: dict) -> dict:
    return {name: reached(entry.function) for name, entry in entries.items()}


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(kept_keys, "private_cache", lambda: tmp_path)
    return tmp_path / kept_keys.KEPT


def test_what_is_kept_is_what_was_walked(
    entries: dict, rests: dict, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    walked = kept_keys.keys_of(PRODUCT, entries, rests, DATA)
    [file] = cache.iterdir()
    monkeypatch.setattr(Keys, "of", None)  # nothing is walked again
    assert kept_keys.keys_of(PRODUCT, entries, rests, DATA) == walked
    file.write_text(json.dumps({NAME: {"source": "x"}}), encoding="utf-8")
    with pytest.raises(TypeError):  # what is not whole is not believed
        kept_keys.keys_of(PRODUCT, entries, rests, DATA)


def test_every_difference_has_another_stamp(
    entries: dict, rests: dict, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stamp(data: dict = DATA, rests: dict = rests) -> str:
        return kept_keys._stamp(PRODUCT, entries, rests, data)

    found = [stamp()]
    record = DATA["kernels"][NAME]
    row = {NAME: {**record, "theorems": [*record["theorems"], "another"]}}
    found.append(stamp({**DATA, "kernels": row}))
    theorem = sorted(DATA["theorems"])[0]
    lemmas = {**DATA["theorems"][theorem], "lemmas": ["another"]}
    found.append(stamp({**DATA, "theorems": {**DATA["theorems"], theorem: lemmas}}))
    for name in ("compiler", "solver_version"):
        with monkeypatch.context() as other:
            other.setattr(kept_keys, name, lambda: "9.9")
            found.append(stamp())
    for value in (7, 8):
        more = {**rests[NAME], "cratous.core.somewhere.LIMIT": value}
        found.append(stamp(rests={NAME: more}))
    assert len(set(found)) == len(found)
    assert stamp() == found[0]


def test_every_file_counts_and_every_folder(tmp_path: Path) -> None:
    (tmp_path / "spec" / "inner").mkdir(parents=True)
    file = tmp_path / "spec" / "inner" / "one.py"
    found = []
    for text in ("x = 1\n", "x = 2\n"):
        file.write_text(text, encoding="utf-8")
        found.append(list(kept_keys._files(tmp_path, "spec")))
    (tmp_path / "spec" / "grammar.lark").write_text("start: A\n", encoding="utf-8")
    found.append(list(kept_keys._files(tmp_path, "spec")))
    (tmp_path / "spec" / "empty").mkdir()
    found.append(list(kept_keys._files(tmp_path, "spec")))
    assert len({tuple(one) for one in found}) == len(found)


def test_names_that_lead_to_what_is_not_hashed_are_not_kept() -> None:
    assert (ROOT / "tests").is_dir()
    assert kept_keys._elsewhere({"cratous.spec.errors", "cratous.tests.conftest"})
    assert not kept_keys._elsewhere({"cratous.spec.errors", "cratous.nowhere", "cratous"})


def test_what_is_missing_is_not_kept(
    entries: dict, rests: dict, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Keys, "source", lambda _self, _entry: MISSING)
    assert kept_keys.keys_of(PRODUCT, entries, rests, DATA)[NAME]["source"] == MISSING
    assert not cache.exists()
