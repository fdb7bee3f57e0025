"""Bands and alerts that a log tells: read as they are, and shown in a real browser, now and over time."""

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
from cratous.services.ground_station.live_flight import LiveFlight
from cratous.services.ground_station.recording import recording
from cratous.services.loading import load
from cratous.services.logs.entry import Entry

CROSSING = Path(__file__).resolve().parents[2] / "examples" / "crossing" / "mission.yaml"
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
    regions = {region for row in rows for _, _, region in row["bands"].get("heading", ())}
    assert regions == {"NEAR", "RECOVERY"}
    assert {name for row in rows for name in row["bands"]} == set(FIELDS)
    for row, said in zip(rows, told, strict=True):
        assert row["own"] == pytest.approx(
            [said.CurrentHeading, said.CurrentGoundSpeed, said.CurrentVerticalSpeed, said.CurrentAltitude],
            abs=0.06,
        )  # fmt: skip
        for name, (intervals, regions_of, ends, recoveries, recovery_ends) in FIELDS.items():
            found = row["bands"].get(name, [])
            told_bands = [
                (*getattr(interval, ends), region.name)
                for interval, region in zip(
                    getattr(said, intervals), getattr(said, regions_of), strict=True
                )
            ]
            told_bands += [
                (*getattr(interval, recovery_ends), "RECOVERY")
                for interval in getattr(said, recoveries)
            ]
            assert [band[2] for band in found] == [band[2] for band in told_bands]
            for band, expected in zip(found, told_bands, strict=True):
                assert band[:2] == pytest.approx(expected[:2], abs=0.06)
        assert [one[0] for one in row["intruders"]] == said.EntityList
        assert [one[2] for one in row["intruders"]] == said.AlertLevelList


FIELDS = {
    "heading": (
        "WCVGroundHeadingIntervals", "WCVGroundHeadingRegions", "GroundHeadings",
        "RecoveryGroundHeadingIntervals", "RecoveryGroundHeadings",
    ),
    "speed": (
        "WCVGroundSpeedIntervals", "WCVGroundSpeedRegions", "GroundSpeeds",
        "RecoveryGroundSpeedIntervals", "RecoveryGroundSpeeds",
    ),
    "climb": (
        "WCVVerticalSpeedIntervals", "WCVVerticalSpeedRegions", "VerticalSpeeds",
        "RecoveryVerticalSpeedIntervals", "RecoveryVerticalSpeed",
    ),
    "altitude": (
        "WCVAlitudeIntervals", "WCVAltitudeRegions", "Altitude", "RecoveryAltitudeIntervals",
        "RecoveryAltitude",
    ),
}  # fmt: skip


def _body(**changed: Any) -> dict[str, Any]:
    return {
        **json.loads(lmcp.to_json(lmcp.new("WellClearViolationIntervals", EntityId=2))),
        "CurrentHeading": 10.04,
        "WCVGroundHeadingIntervals": [{"GroundHeadings": [350.0, 20.0]}],
        "WCVGroundHeadingRegions": ["NEAR"],
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
    assert [row["own"][0] for row in bands.found["2"]] == [0, 3, 5]
    assert bands.take_new() == bands.found
    assert bands.take_new() == {}
    assert bands.unread == 0


def test_a_live_flight_tells_its_bands_once() -> None:
    sent: list[dict[str, Any]] = []
    live = LiveFlight(load(CROSSING), sent.append, -1)
    live._recording.add(Entry(0, 500, "", BANDS, json.dumps(_body())))
    live.tell()
    live.tell()
    told = [update["bands"] for update in sent if "bands" in update]
    assert [rows[0]["bands"] for one in told for rows in one.values()] == [
        {"heading": [(350.0, 20.0, "NEAR")]}
    ]


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
        {"WCVAltitudeRegions": ["NEAR"]},
        {"RecoveryVerticalSpeedIntervals": [{}]},
        {"CurrentGoundSpeed": None},
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
    assert row["bands"] == {"heading": [(350.0, 20.0, "NEAR")]}
    assert row["time_ms"] == 1200


def _pixels(page: Page, name: str, canvas: str = "#map .drawing") -> int:
    """Pixels of a canvas in a colour of the style sheet."""
    return int(
        page.value(f"""(() => {{
        const hex = getComputedStyle(document.documentElement).getPropertyValue('--{name}').trim();
        const [r, g, b] = [1, 3, 5].map(k => parseInt(hex.slice(k, k + 2), 16));
        const map = document.querySelector('{canvas}');
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
    k, row = next(
        (k, row)
        for k, row in enumerate(rows)
        if regions == {b[2] for b in row["bands"].get("heading", ())}
    )
    with serving(log) as (_, port), browsing(tmp_path / "profile") as page:
        page.go(f"http://127.0.0.1:{port}/#t=0&theme=light")
        page.until(READY)
        note = _at(page, k + 0.4)
        assert note.startswith(f"Aircraft 2, told at {k}.0 s: heading 10.0°, speed 50.0 m/s, ")
        assert note.endswith("not judged here.")
        written = page.value(
            "[...document.querySelectorAll('#bands tr')].slice(1)"
            ".map(row => [...row.children].map(cell => cell.textContent))"
        )
        bands = row["bands"]
        assert [line[0] for line in written] == [name for name in bands for _ in bands[name]]
        assert [line[1:] for line in written if line[0] == "heading"] == [
            [f"{low:.1f}° to {high:.1f}°", region.lower()] for low, high, region in bands["heading"]
        ]
        assert [line[1:] for line in written if line[0] == "altitude"] == [
            [f"{low:.0f} m to {high:.0f} m", region.lower()]
            for low, high, region in bands["altitude"]
        ]
        assert page.value("document.querySelectorAll('#intruders tr').length") == 2
        drawn = {region: _pixels(page, f"band-{region.lower()}") for region in regions}
        assert min(drawn.values()) > 100
        assert _at(page, k + 1, "&aircraft=1") == "Pick an aircraft: the log has bands of 2."
        assert page.text("bands") == page.text("intruders") == ""
        for region in regions:
            # what is left is the square around an intruder with an alert
            assert _pixels(page, f"band-{region.lower()}") < drawn[region] / 2, region
        assert page.logged == []
        _charts(page, rows)
        assert page.logged == []


def _charts(page: Page, rows: list[Any]) -> None:
    """The tapes, the alert, and the bands over time of the same log."""
    (_, time_s, level) = rows[5]["intruders"][0]
    _at(page, 5, "&aircraft=2")
    assert f"▲ alert {level:g} for 2, violation in {time_s:.1f} s" in _shown(page, "aircraft")
    assert _pixels(page, "band-near", "#tapes") > 100
    assert _pixels(page, "band-near", "#spectrum") > 1000
    before = page.value("document.getElementById('spectrum').toDataURL()")
    page.key("b")
    assert page.value("location.hash").endswith("&bands=speed")
    assert page.value("document.getElementById('dimension').value") == "speed"
    assert page.value("document.getElementById('spectrum').toDataURL()") != before
    page.click("#spectrum")
    assert 12 < float(page.value("document.getElementById('slider').value")) / 1000 < 18


def _shown(page: Page, name: str) -> str:
    """The text of an element with what its style sheet puts before the parts."""
    return str(
        page.value(f"""[...document.querySelectorAll('#{name} .alert')].map(one =>
            getComputedStyle(one, '::before').content.slice(1, -1) + one.textContent).join()""")
    )


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
