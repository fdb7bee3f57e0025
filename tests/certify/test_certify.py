"""`cratous certify`: whatever is edited in a results folder is found, or said not to be checked."""

from __future__ import annotations

import copy
import functools
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from certify_tools import Run, edited, read
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cratous.services.certify import rejudge, report, result_files
from cratous.services.cli import main
from cratous.services.results.names import COMMANDED_NAME
from cratous.services.results.ownership import manifest_text

FEW = 2


def places(data: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The path of everything in it, leaves and what holds them; of a list the first and the last."""
    if path:
        yield path
    if isinstance(data, dict):
        for key, value in data.items():
            yield from places(value, (*path, key))
    elif isinstance(data, list):
        for k in sorted({0, len(data) - 1} if data else set()):
            yield from places(data[k], (*path, k))


def short(data: Any) -> Any:
    """The same with a few entries of each list."""
    if isinstance(data, dict):
        return {key: short(value) for key, value in data.items()}
    if isinstance(data, list):
        return [short(part) for part in [*data[: FEW - 1], *data[FEW - 1 :][-1:]]]
    return data


OTHER: tuple[Any, ...] = (
    None,
    True,
    7,
    -0.5,
    "other",
    [],
    {},
    [None],
    {"a": [1]},
    10**400,
    "\x1b[2J",
)


def edits(value: Any) -> Iterator[Any]:
    """Another value of the same type, and values of other types."""
    if isinstance(value, bool):
        yield not value
    elif isinstance(value, int):
        yield from (value + 1, -value - 1, float(value))
    elif isinstance(value, float):
        yield from (value + 1e-9 * max(1.0, abs(value)), -value - 1.0)
    elif isinstance(value, str):
        yield from (value + " ", value[:-1] if value else "x", value.upper() + "!")
    elif isinstance(value, list):
        yield [*value, *value[:1]] if value else [0]
        yield value[1:] if value else [[]]
    elif isinstance(value, dict):
        yield {**value, "added": 1}
    yield from OTHER


def at(data: Any, path: tuple[Any, ...]) -> Any:
    for part in path:
        data = data[part]
    return data


def same(one: Any, other: Any) -> bool:
    return json.dumps(one, sort_keys=True) == json.dumps(other, sort_keys=True)


@pytest.mark.long
def test_every_edit_of_every_entry_is_found(
    flown: Path, judged: None, tmp_path: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    """Of lists of many the first and last; each kind of place gets every edit, and is then deleted."""
    folder = edited(flown, tmp_path)
    file, whole = folder / "report.json", read(folder)
    full, silent, wrong = rejudge.rebuilt(folder / "log.sqlite", whole)
    assert same(full, whole)
    # judged once, and short of the many entries of long lists: what follows only compares
    whole = short(whole)
    rebuilt = (copy.deepcopy(whole), silent, wrong)
    texts = report.pages(full)
    monkeypatch.setattr(rejudge, "rebuilt", lambda *_log: copy.deepcopy(rebuilt))
    monkeypatch.setattr(result_files, "pages", lambda _report: dict(texts))
    monkeypatch.setattr(rejudge, "subject", functools.cache(rejudge.subject))
    tried = 0
    for path in list(places(whole)):
        holder, value = at(whole, path[:-1]), at(whole, path)
        for new in [*edits(value), KeyError]:
            if isinstance(holder, list) if new is KeyError else same(value, new):
                continue
            if new is KeyError:
                del holder[path[-1]]
            else:
                holder[path[-1]] = new
            tried += 1
            found = rejudge.differences(whole, rebuilt[0])
            holder[path[-1]] = value
            assert found, (path, new)
            assert all(len(line) < 400 for line in found)
            assert not any("\x1b" in line for line in found)
    assert tried > 3000
    # and through the whole command, what stands at the top and one level below
    tops = [path for path in places(whole) if len(path) <= 2 and path[-1] != 0]
    capsys.readouterr()
    for path in tops:
        holder, value = at(whole, path[:-1]), at(whole, path)
        for new in (*list(edits(value))[:1], None, "other", [1], KeyError):
            if new is KeyError and isinstance(holder, dict):
                del holder[path[-1]]
            elif new is KeyError or same(value, new):
                continue
            else:
                holder[path[-1]] = new
            file.write_text(json.dumps(whole), encoding="utf-8")
            holder[path[-1]] = value
            code = main(["certify", str(folder)])
            printed = capsys.readouterr()
            assert code in (1, 2), (path, new, printed)
            assert code == 2 or str(path[0]) in printed.err, (path, new)
            assert "internal error" not in printed.err
            assert "confirmed" not in printed.out


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=9),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)  # fmt: skip


@settings(
    max_examples=30,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(data=st.data())
def test_whatever_stands_in_an_entry(
    flown: Path, judged: None, tmp_path: Path, capsys: pytest.CaptureFixture[str], data: st.DataObject
) -> None:  # fmt: skip
    """Any JSON in any entry, judged by the whole command: never confirmed, never an internal error."""
    folder = tmp_path / "edited"
    if not folder.exists():
        edited(flown, tmp_path)
    whole = read(flown)
    path = data.draw(st.sampled_from(_places(flown)))
    new = data.draw(JSON)
    if same(at(whole, path), new):
        return
    at(whole, path[:-1])[path[-1]] = new
    (folder / "report.json").write_text(json.dumps(whole), encoding="utf-8")
    code = main(["certify", str(folder)])
    printed = capsys.readouterr()
    assert code in (1, 2), (path, new, printed)
    assert "internal error" not in printed.err


@functools.cache
def _places(folder: Path) -> list[tuple[Any, ...]]:
    return list(places(read(folder)))


def test_what_is_not_edited_is_confirmed_and_nothing_written(
    run: Run, flown: Path, judged: None
) -> None:
    before = {file.name: file.stat().st_mtime_ns for file in flown.iterdir()}
    code, out, err = run("certify", flown)
    assert (code, err) == (read(flown)["exit_code"], "")
    assert "confirmed" in out
    assert "not checked" not in out, "of a log of this version everything is"
    assert run("certify", flown, "--rewrite")[0] == code
    assert {file.name: file.stat().st_mtime_ns for file in flown.iterdir()} == before


def test_an_edited_environment(run: Run, flown: Path, judged: None, tmp_path: Path) -> None:
    for new in ({}, [], "x", None, {"python": "9", "system": "", "packages": {}}):
        folder = edited(flown, tmp_path)
        whole = read(folder)
        whole["environment"] = new
        (folder / "report.json").write_text(json.dumps(whole), encoding="utf-8")
        code, out, err = run("certify", folder)
        assert (code, out) == (1, "")
        assert "environment" in err


@pytest.mark.parametrize("name", ["report.html", "map.svg", "manifest.json"])
def test_an_edited_page_is_a_finding(
    run: Run, flown: Path, judged: None, tmp_path: Path, name: str
) -> None:
    folder = edited(flown, tmp_path)
    file, good = folder / name, (flown / name).read_bytes()
    for bad in (good[:900] + b"!" + good[901:], good + b" ", b"", b"\xff\x00", None):
        file.unlink() if bad is None else file.write_bytes(bad)
        code, out, err = run("certify", folder)
        assert (code, out) == (1, ""), bad
        assert name in err
        assert (file.read_bytes() if bad is not None else None) == bad, "nothing is written"
        assert not file.exists() or bad is not None
    code, out, err = run("certify", folder, "--rewrite")
    assert (code, err) == (read(flown)["exit_code"], "")
    assert f"rewritten: {name}" in out
    assert file.read_bytes() == good
    assert run("certify", folder)[0] == code


def test_rewrite_touches_nothing_that_is_not_confirmed(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    folder = edited(flown, tmp_path)
    whole = read(folder)
    whole["verdict"] = "violated"
    (folder / "report.json").write_text(json.dumps(whole), encoding="utf-8")
    (folder / "report.html").write_text("mine")
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    code, out, err = run("certify", folder, "--rewrite")
    assert (code, out) == (1, "")
    assert "verdict: written" in err
    assert "report.html, line 1" in err
    assert {file.name: file.read_bytes() for file in folder.iterdir()} == before


def test_bytes_count_too(run: Run, flown: Path, judged: None, tmp_path: Path) -> None:
    folder = edited(flown, tmp_path)
    (folder / "report.json").write_text(json.dumps(read(folder)), encoding="utf-8")
    code, _, err = run("certify", folder)
    assert (code, "report.json, line 1" in err) == (1, True)
    folder = edited(flown, tmp_path)
    certificate = json.loads((folder / "certificate.json").read_text())
    (folder / "certificate.json").write_text(json.dumps(certificate, indent=2))
    code, _, err = run("certify", folder)
    assert (code, "certificate.json: SHA-256" in err) == (1, True)


def test_other_files_are_said_not_to_be_checked(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    folder = edited(flown, tmp_path)
    (folder / "notes.txt").write_text("mine")
    code, out, _ = run("certify", folder)
    assert code == read(flown)["exit_code"]
    assert "not checked: notes.txt" in out
    assert json.loads(run("certify", folder, "--json")[1])["not_checked"] == [
        "notes.txt: no file of the results"
    ]


def test_the_mission_with_commands_of_an_operator_is_the_one_that_was_flown(
    run: Run, flown: Path, judged: None, root: Path, tmp_path: Path
) -> None:
    folder = edited(flown, tmp_path)
    file, text = folder / COMMANDED_NAME, (root / "examples/crossing/mission.yaml").read_text()

    def certified(said: str, *, stated: bool = True) -> tuple[int, str, str]:
        file.write_text(said, encoding="utf-8")
        names = [file.name for file in folder.iterdir() if file.name != "manifest.json"]
        if stated:
            whole = manifest_text(folder, sorted(names))
            (folder / "manifest.json").write_text(whole, encoding="utf-8")
        return run("certify", folder)

    code, out, err = certified(text)
    assert (code, err) == (read(flown)["exit_code"], "")
    assert COMMANDED_NAME not in out
    code, out, err = certified(text.replace("speed_m_s: 22", "speed_m_s: 21"))
    assert (code, f"{COMMANDED_NAME}: it is not the mission" in err) == (1, True), err
    code, out, err = certified("name: crossing\n")
    assert (code, f"{COMMANDED_NAME}: " in err) == (1, True), err
    code, out, err = certified(text + "\n", stated=False)
    assert (code, f"{COMMANDED_NAME}: SHA-256" in err) == (1, True), err
