"""The page in a real browser, headless: an instant by its address, and errors that are said."""

from __future__ import annotations

import html
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from ground_station_tools import LIMIT_S, dom, serving

PAGE = Path(__file__).resolve().parents[2] / "services" / "ground_station" / "page"


def _text(markup: str) -> str:
    return html.unescape(re.sub(r"<[^>]+>", " ", markup))


def _table(document: str, name: str) -> str:
    found = re.search(rf'<(table|ol) id="{name}"[^>]*>(.*?)</\1>', document, re.DOTALL)
    assert found, name
    return found.group(2)


def _authority(document: str, vehicle: int) -> str:
    rows = re.findall(
        rf'<tr data-aircraft="{vehicle}".*?</tr>', _table(document, "aircraft"), re.DOTALL
    )
    assert len(rows) == 2
    return " ".join(_text(rows[1]).split())


def test_dark_colours_are_for_screens_alone() -> None:
    for sheet, dark in (
        (PAGE / "station.css", "@media screen { :root.dark {"),
        (
            PAGE.parents[1] / "certify" / "report.css",
            "@media screen and (prefers-color-scheme: dark) {",
        ),
    ):
        text = sheet.read_text()
        assert text.count(dark) == 1
        assert not re.search(r"prefers-color-scheme: dark|:root\.dark", text.replace(dark, ""))


@pytest.mark.slow
def test_an_address_opens_the_run_at_its_instant(crossing: Path, tmp_path: Path) -> None:
    """In the takeover, before it and after it."""
    with serving(crossing) as (_, port):
        url = f"http://127.0.0.1:{port}/"
        during = dom(f"{url}#t=30&aircraft=2&units=aviation&theme=dark", tmp_path)
        before = dom(f"{url}#t=21", tmp_path)
        after = dom(f"{url}#t=100", tmp_path)
    told = _authority(during, 2)
    assert told.startswith("authority ICAROUS since 21.5 s: traffic: loss predicted in 57.9 s")
    assert "link alive" in told
    assert _authority(during, 1).startswith("authority UxAS")
    assert '<html lang="en" class="dark">' in during
    assert re.search(r'<output id="clock">00:00:30\.0 of 00:03:40\.8</output>', during)
    assert "984 ft" in _table(during, "aircraft")  # 300 m
    assert 'class="picked"' in _table(during, "aircraft")
    assert _authority(before, 2).startswith("authority UxAS")
    assert _authority(after, 2).startswith("authority UxAS")
    assert "300 m" in _table(after, "aircraft")
    (now,) = re.findall(r'<li class="now">(.*?)</li>', _table(during, "events"), re.DOTALL)
    assert "ICAROUS takes over because of 1" in _text(now)
    assert "231.4&nbsp;ft" in _table(during, "verdicts")  # 70.54 m
    assert '<span id="overall" class="holds">holds</span>' in during


@pytest.mark.slow
def test_an_address_that_is_not_as_it_should_be_is_the_beginning(
    crossing: Path, tmp_path: Path
) -> None:
    with serving(crossing) as (_, port):
        found = dom(
            f"http://127.0.0.1:{port}/#t=x&rate=3&aircraft=9&map=0,0,-1&theme=<b>", tmp_path
        )
    assert '<output id="clock">00:00:00.0' in found
    assert "picked" not in _table(found, "aircraft")


@pytest.mark.slow
def test_a_damaged_log_is_told_in_the_page(tmp_path: Path) -> None:
    log = tmp_path / "damaged.jsonl"
    log.write_text('{"seq": 0, "time_ms": 0\n')
    with serving(log) as (_, port):
        found = dom(f"http://127.0.0.1:{port}/", tmp_path / "profile")
    said = re.search(r'<p id="message" [^>]*role="alert"[^>]*>(.*?)</p>', found, re.DOTALL)
    assert said
    assert "This log cannot be shown" in said.group(1)
    assert str(log) in said.group(1)
    assert re.search(r'<main id="station" hidden="">', found)


def test_the_scripts_can_be_read(tmp_path: Path) -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("there is no node on this machine")
    scripts = sorted(PAGE.glob("*.js"))
    assert len(scripts) >= 8
    for script in scripts:
        copy = tmp_path / f"{script.stem}.mjs"
        shutil.copy(script, copy)
        done = subprocess.run(
            [node, "--check", str(copy)], capture_output=True, text=True, timeout=LIMIT_S
        )
        assert done.returncode == 0, f"{script.name}: {done.stderr}"
