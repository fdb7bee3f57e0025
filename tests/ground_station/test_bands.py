"""Heading bands that a log tells: read as they are, and shown around their vehicle in a real browser."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from chromium_tools import Page, browsing
from daidalus_sky import SEES, Craft, Sky, fly
from ground_station_tools import serving
from log_tools import write

from cratous.bridge import lmcp
from cratous.services.ground_station.bands import BANDS, Bands
from cratous.services.ground_station.recording import recording
from cratous.services.logs.entry import Entry

READY = "document.getElementById('bands-note')?.textContent"


def _log(folder: Path, seconds: int = 30) -> tuple[Path, list[Any]]:
    """The log of two aircraft that fly at each other, 2 with detection; and what that said."""
    sky = Sky(folder, SEES)
    fly(sky, [Craft(2, 0.0, 0.0, 10.0), Craft(1, 6000.0, 0.0, 180.0)], seconds)
    made = [
        Entry(k, e.time_ms, e.source, e.topic, lmcp.to_json(e.body)) for k, e in enumerate(sky.all)
    ]
    return write(folder / "log.sqlite", made), sky.got("WellClearViolationIntervals")


def test_the_bands_of_a_log_are_those_of_its_messages(tmp_path: Path) -> None:
    log, told = _log(tmp_path)
    found = recording(log)
    assert found["unread"] == 0
    ((vehicle, rows),) = found["bands"].items()
    assert vehicle == "2"
    assert len(rows) == len(told) == 30
    assert [row["time_ms"] for row in rows] == list(range(0, 30_000, 1000))
    assert {region for row in rows for _, _, region in row["bands"]} == {"NEAR", "RECOVERY"}
    for row, said in zip(rows, told, strict=True):
        assert row["heading_deg"] == round(said.CurrentHeading, 1)
        told_bands = [
            [*(round(end, 1) for end in interval.GroundHeadings), region.name]
            for interval, region in zip(
                said.WCVGroundHeadingIntervals, said.WCVGroundHeadingRegions, strict=True
            )
        ]
        told_bands += [
            [*(round(end, 1) for end in interval.RecoveryGroundHeadings), "RECOVERY"]
            for interval in said.RecoveryGroundHeadingIntervals
        ]
        assert [list(band) for band in row["bands"]] == told_bands
        assert [one[0] for one in row["intruders"]] == said.EntityList


def _body(**changed: Any) -> dict[str, Any]:
    return {
        "$type": "DAIDALUS/WellClearViolationIntervals", "EntityId": 2, "CurrentHeading": 10.04,
        "WCVGroundHeadingIntervals": [{"GroundHeadings": [350.0, 20.0]}],
        "WCVGroundHeadingRegions": ["NEAR"], "RecoveryGroundHeadingIntervals": [],
        "EntityList": [1], "TimeToViolationList": [5.0], "AlertLevelList": [3.0], **changed,
    }  # fmt: skip


def _read(*bodies: Any) -> Bands:
    bands = Bands()
    for k, body in enumerate(bodies):
        text = body if isinstance(body, str) else json.dumps(body)
        bands.add(Entry(k, 400 * k, "", BANDS, text), 400 * k)
    return bands


def test_the_first_message_of_each_second_stays() -> None:
    bands = _read(*(_body(CurrentHeading=k) for k in range(6)))
    assert [row["heading_deg"] for row in bands.found["2"]] == [0, 3, 5]
    assert bands.unread == 0


@pytest.mark.parametrize(
    "changed",
    [
        {"WCVGroundHeadingRegions": []},
        {"WCVGroundHeadingRegions": ["NEARBY"]},
        {"WCVGroundHeadingRegions": [["NEAR"]]},
        {"WCVGroundHeadingIntervals": [{"GroundHeadings": [350.0]}]},
        {"WCVGroundHeadingIntervals": [{"GroundHeadings": [350.0, None]}]},
        {"WCVGroundHeadingIntervals": [{"GroundHeadings": [350.0, 1e999]}]},
        {"WCVGroundHeadingIntervals": 7},
        {"EntityId": None},
        {"EntityList": [1, 2]},
        {"EntityList": [1e999]},
        {"CurrentHeading": "north"},
    ],
)
def test_a_message_that_does_not_fit_is_counted_and_not_shown(changed: dict[str, Any]) -> None:
    bands = _read(_body(**changed), "{", "[]", _body())
    assert bands.unread == 3
    (row,) = bands.found["2"]
    assert row["bands"] == [(350.0, 20.0, "NEAR")]
    assert row["time_ms"] == 1200


def _pixels(page: Page, name: str) -> int:
    """Pixels of the map in a colour of the style sheet."""
    return int(
        page.value(f"""(() => {{
        const hex = getComputedStyle(document.documentElement).getPropertyValue('--{name}').trim();
        const [r, g, b] = [1, 3, 5].map(k => parseInt(hex.slice(k, k + 2), 16));
        const map = document.getElementById('map');
        const pixels = map.getContext('2d').getImageData(0, 0, map.width, map.height).data;
        let found = 0;
        for (let k = 0; k < pixels.length; k += 4)
            found += pixels[k] === r && pixels[k + 1] === g && pixels[k + 2] === b;
        return found;
    }})()""")
    )


def _at(page: Page, time_s: float, more: str = "") -> str:
    page.value(f"location.hash = '#t={time_s:g}&theme=light{more}'")
    page.until(f"document.getElementById('clock').textContent.includes(':{int(time_s):02d}.')")
    return page.text("bands-note")


@pytest.mark.slow
def test_the_bands_of_an_instant_are_drawn_and_written(tmp_path: Path) -> None:
    log, _ = _log(tmp_path)
    rows = recording(log)["bands"]["2"]
    regions = {"NEAR", "RECOVERY"}
    k, row = next((k, row) for k, row in enumerate(rows) if regions == {b[2] for b in row["bands"]})
    with serving(log) as (_, port), browsing(tmp_path / "profile") as page:
        page.go(f"http://127.0.0.1:{port}/#t=0&theme=light")
        page.until(READY)
        note = _at(page, k + 0.4)
        assert note.startswith(f"Aircraft 2, told at {k}.0 s: heading 10.0°.")
        assert note.endswith("not judged here.")
        written = page.value(
            "[...document.querySelectorAll('#bands tr')].slice(1)"
            ".map(row => [...row.children].map(cell => cell.textContent))"
        )
        assert written == [
            [f"{low:.1f}° to {high:.1f}°", region.lower()] for low, high, region in row["bands"]
        ]
        assert page.value("document.querySelectorAll('#intruders tr').length") == 2
        for region in regions:
            assert _pixels(page, f"band-{region.lower()}") > 100, region
        assert _at(page, k + 1, "&aircraft=1") == "Pick an aircraft: the log has bands of 2."
        assert page.text("bands") == page.text("intruders") == ""
        for region in regions:
            assert _pixels(page, f"band-{region.lower()}") < 20, region
        assert page.logged == []


@pytest.mark.slow
def test_where_no_bands_are_told_the_page_says_so(tmp_path: Path) -> None:
    log, _ = _log(tmp_path)
    bare = tmp_path / "bare.sqlite"
    made = recording(log)
    assert made["end_ms"] >= 29_000
    entries = [
        Entry(k, 1000 * k, "", "afrl.cmasi.AirVehicleState", lmcp.to_json(Craft(2, 0.0, 50.0 * k, 0.0).state(k)))
        for k in range(20)
    ]  # fmt: skip
    told = Entry(20, 500, "", BANDS, json.dumps(_body()))
    write(bare, entries)
    some = write(
        tmp_path / "some.sqlite",
        [*entries[:1], told._replace(seq=1), *(e._replace(seq=e.seq + 1) for e in entries[1:])],
    )
    for path, expected in (
        (bare, "Not in the log: it has no WellClearViolationIntervals."),
        (some, "Aircraft 2: none told since 0.5 s."),
    ):
        with serving(path) as (_, port), browsing(tmp_path / path.stem) as page:
            page.go(f"http://127.0.0.1:{port}/#t=0&theme=light")
            page.until(READY)
            assert _at(page, 9) == expected
            assert page.value("document.querySelectorAll('#bands tr').length") == 0
            if path == some:
                assert _at(page, 0) == "Aircraft 2: none told yet."
                assert _at(page, 2.0).startswith("Aircraft 2, told at 0.5 s")
