"""A mission that is edited and planned in a real browser."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import pytest
from chromium_tools import Page
from editor_tools import TEXT, click_map, data, drag_pixels, place, write
from ground_station_tools import Served

pytestmark = pytest.mark.slow


def test_an_error_in_the_algebra_is_shown_at_its_place_while_typing(page: Page) -> None:
    write(page, "relations", "|(p1 (p2))")
    page.until("document.querySelector('#relations-shown .fault')?.textContent === '('")
    error = page.text("relations-error")
    assert error.startswith("|(p1 (p2))\n     ^\n")
    assert "an operator must stand before the parenthesis" in error
    assert 'relations: "|(p1 p2)"' in page.value(TEXT)  # the text keeps what was a term
    assert page.text("saved") == "saved; the relations typed are not in the file"
    write(page, "relations", ".(p1 p2)_[0-400000]")
    page.until(f"{TEXT}.includes('relations: \".(p1 p2)_[0-400000]\"')")
    assert page.text("relations-error") == ""
    assert "p2 starts no earlier than p1 ends" in page.text("relations-rows")


def test_a_keep_out_is_drawn_and_the_mission_planned_anew(page: Page, mission: Path) -> None:
    before = page.value(TEXT)
    page.click("[data-tool=keep_out]")
    for north, east in ((-300, 1000), (-300, 1500), (300, 1500), (300, 1000)):
        click_map(page, north, east)
    page.click("#finish")
    page.until(f"{TEXT}.includes('kind: keep_out')")
    page.until("document.getElementById('saved').textContent === 'not saved'")
    page.click("#plan")
    page.until("document.querySelectorAll('#gantt .bar').length === 2")
    state = page.text("plan-state")
    assert state.startswith("plan: ")
    assert "zone: keep_out 1, planned route of vehicle 2holds" in page.text("constraints")
    page.value(
        "document.querySelector('#gantt .bar[data-task=\"2\"]').dispatchEvent(new Event('click'))"
    )
    page.until(
        "document.getElementById('why').textContent.includes('task 2 is given to vehicle 2')"
    )
    page.click("#save")
    page.until("document.getElementById('saved').textContent === 'saved'")
    assert mission.read_text(encoding="utf-8") == page.value(TEXT)
    page.click("#undo")
    page.until(f"!{TEXT}.includes('kind: keep_out')")
    assert page.value(TEXT) == before
    assert page.text("plan-state").startswith("Of an earlier text: ")
    page.click("#redo")
    page.until(f"{TEXT}.includes('kind: keep_out')")
    assert page.text("plan-state") == state


def test_a_plan_of_another_page_is_not_shown_as_its_own(page: Page, editor: Served) -> None:
    # it looks for its plan when the other one has begun
    page.value(
        "(ask => { window.held = []; window.ask = ask; window.fetch = async (path, ...more) => {"
        " if (path === '/planned.json') await new Promise(go => window.held.push(go));"
        " return ask(path, ...more); }; })(window.fetch)"
    )
    page.click("#plan")
    page.until("window.held.length")
    other = page.value(TEXT).replace("east_m: 2500", "east_m: 2600")
    editor.edit("/plan", text=other)
    page.value("window.fetch = window.ask; window.held.forEach(go => go())")
    said = "Another page planned its text before this plan was made: plan again."
    page.until(f"document.getElementById('plan-state').textContent === {said!r}")
    page.click("#plan")
    page.until("document.querySelectorAll('#gantt .bar').length === 2")
    state = page.text("plan-state")
    editor.edit("/plan", text=other)
    # what it has stays, and its reasons are not those of the other plan
    page.value(
        "document.querySelector('#gantt .bar[data-task=\"2\"]').dispatchEvent(new Event('click'))"
    )
    page.until("document.getElementById('saved').textContent.includes('no such plan any more')")
    assert page.text("plan-state") == state
    assert page.text("why") == ""


def test_a_plan_of_kernels_without_proof_says_so(page: Page) -> None:
    page.value(
        "(ask => { window.fetch = async (path, ...more) => { const got = await ask(path, ...more);"
        " if (path !== '/planned.json') return got; const told = await got.json();"
        " const unproved = { exit_code: 3, proofs: '2 kernels; 1 NOT VOUCHED FOR' };"
        " return { json: async () => told.state === 'planned' ? { ...told, ...unproved } : told };"
        "}; })(window.fetch)"
    )
    page.click("#plan")
    page.until("document.querySelectorAll('#gantt .bar').length === 2")
    assert page.text("plan-state").endswith("; proofs: 2 kernels; 1 NOT VOUCHED FOR")
    assert page.value("document.getElementById('plan-state').className") == "bad"


def test_what_was_typed_last_is_kept_by_the_next_change(page: Page) -> None:
    typed = page.value(TEXT).replace("east_m: 2500", "east_m: 2600")
    write(page, "text", typed)  # the pause after typing is not waited for
    write(page, "relations", ".(p1 p2)")
    page.until(f"{TEXT}.includes('relations: \".(p1 p2)\"')")
    assert "east_m: 2600" in page.value(TEXT)
    # undone with the cursor in their field
    page.value(
        "document.getElementById('relations').dispatchEvent(new KeyboardEvent('keydown',"
        " { key: 'z', ctrlKey: true, bubbles: true }))"
    )
    page.until("document.getElementById('relations').value === '|(p1 p2)'")
    # what is no term outlives changes elsewhere
    write(page, "relations", "|(p1 (p2))")
    page.until("document.getElementById('relations-error').textContent !== ''")
    write(page, "text", page.value(TEXT).replace("east_m: 2600", "east_m: 2700"))
    page.until(
        "document.getElementById('saved').textContent.startsWith('not saved; the relations')"
    )
    assert page.value("document.getElementById('relations').value") == "|(p1 (p2))"


def test_relations_that_are_undone_before_the_text_was_looked_at_are_undone_in_their_field(
    page: Page,
) -> None:
    page.value(
        "(ask => { window.held = []; window.fetch = async (path, ...more) => {"
        " if (path === '/sketch') await new Promise(go => window.held.push(go));"
        " return ask(path, ...more); }; })(window.fetch)"
    )
    write(page, "relations", ".(p1 p2)")
    page.until(f"{TEXT}.includes('relations: \".(p1 p2)\"')")
    page.click("#undo")
    page.until(f"!{TEXT}.includes('relations: \".(p1 p2)\"')")
    page.value("window.held.forEach(go => go())")
    page.until("document.getElementById('relations').value === '|(p1 p2)'")
    page.until("!document.getElementById('saved').textContent.includes('relations typed')")


def test_a_place_is_dragged_and_removed_with_its_task(page: Page) -> None:
    drag(page, (0, 2500), (600, 2000))
    page.until(f"!{TEXT}.includes('east_m: 2500, alt_m: 300')")
    page.until("!document.getElementById('remove').disabled")
    page.click("#remove")
    page.until(f"!{TEXT}.includes('delivery point')")
    page.until("document.getElementById('problems').textContent.includes('relations')")
    assert page.value("document.getElementById('plan').disabled")


def test_a_vehicle_an_area_and_a_loiter_are_drawn_dragged_and_undone(
    page: Page, mission: Path
) -> None:
    before = page.value(TEXT)
    page.click("[data-tool=vehicle]")
    assert "as of the first vehicle" in page.text("hint")
    click_map(page, -800, 1200)
    page.until("document.querySelectorAll('#export-vehicle option').length === 3")
    page.click("[data-tool=area_search]")
    for north, east in ((300, 900), (300, 1500), (700, 1500)):
        click_map(page, north, east)
    page.key("Enter")
    page.until(f"{TEXT}.includes('kind: area_search')")
    page.click("[data-tool=loiter]")
    assert page.value("!document.getElementById('circles').hidden")
    page.value("document.getElementById('circles-s').value = '0'")
    click_map(page, -400, 1200)
    click_map(page, -400, 1500)
    assert "More than 0" in page.text("hint")
    page.value("document.getElementById('circles-s').value = '75'")
    page.click("#circles-s")
    page.key("Enter")
    page.until(f"{TEXT}.includes('kind: loiter')")
    assert page.value("document.getElementById('circles').hidden")
    drawn = data(page)
    new, area, loiter = drawn["vehicles"][-1], *drawn["tasks"][-2:]
    first = drawn["vehicles"][0]
    assert new["id"] == 3
    assert new["speed_m_s"] == first["speed_m_s"]
    assert new["position"]["alt_m"] == first["position"]["alt_m"]
    assert (new["position"]["north_m"], new["position"]["east_m"]) == near(-800, 1200)
    assert [(p["north_m"], p["east_m"]) for p in area["points"]] == [
        near(300, 900), near(300, 1500), near(700, 1500),
    ]  # fmt: skip
    ((centre,), radius_m) = loiter["points"], loiter["radius_m"]
    assert (centre["north_m"], centre["east_m"]) == near(-400, 1200)
    assert radius_m == pytest.approx(300, abs=30)
    assert loiter["duration_s"] == 75
    page.click("#save")
    page.until("document.getElementById('saved').textContent === 'saved'")
    drag(page, (new["position"]["north_m"], new["position"]["east_m"]), (-1000, 900))
    page.until(f"!{TEXT}.includes('north_m: {new['position']['north_m']}')")
    place_now = data(page)["vehicles"][-1]["position"]
    assert (place_now["north_m"], place_now["east_m"]) == near(-1000, 900)
    page.until("!document.getElementById('remove').disabled")
    page.click("#remove")
    page.until("document.querySelectorAll('#export-vehicle option').length === 2")
    for _ in range(5):
        page.click("#undo")
    page.until(f"{TEXT} === {json.dumps(before)}")
    for _ in range(3):
        page.click("#redo")
    page.until(f"{TEXT} === {json.dumps(mission.read_text(encoding='utf-8'))}")


def near(north: float, east: float) -> Any:
    """A place, to within what two pixels of the map are."""
    return pytest.approx((north, east), abs=25)


def drag(page: Page, at: tuple[float, float], to: tuple[float, float]) -> None:
    """Drag what is at a place of the map to another one."""
    drag_pixels(page, place(page, *at), place(page, *to))


def test_windows_of_tasks_are_bands_behind_the_bars(page: Page) -> None:
    write(page, "relations", "|(p1 p2_[20000-9000000])")
    page.until(f"{TEXT}.includes('p2_[20000-9000000]')")
    page.click("#plan")
    page.until("document.querySelectorAll('#gantt .bar').length === 2")
    assert page.value(
        "[...document.querySelectorAll('#gantt .window')].map(w => w.dataset.window)"
    ) == ["2"]
    title = page.value("document.querySelector('#gantt .window title').textContent")
    assert title.startswith("p2 may be done from 20.0 to 9000.0 s\n`p2_[20000-9000000]`: p2 starts")
    spans = (
        "(q => [q.x.baseVal.value, q.x.baseVal.value + q.width.baseVal.value])"
        "(document.querySelector('#gantt {}'))"
    )
    band, bar = (
        page.value(spans.format(".window rect")),
        page.value(spans.format('.bar[data-task="2"]')),
    )
    assert band[0] <= bar[0]
    assert (bar[1], band[1]) == pytest.approx(
        (630, 630)
    )  # it ends where the chart does, without an edge
    assert page.value("document.querySelectorAll('#gantt .window line').length") == 1
    before = (
        "(w => w.compareDocumentPosition(document.querySelector('#gantt .bar[data-task=\"2\"]')))"
        "(document.querySelector('#gantt .window'))"
    )
    assert page.value(before) & 4  # drawn first, so beneath
    label = page.value("document.querySelector('#gantt .bar[data-task=\"2\"]').ariaLabel")
    assert "; may be done from 20.0 to 9000.0 s. Why" in label


def test_what_is_wrong_is_listed_and_leads_to_its_line(page: Page) -> None:
    write(page, "text", page.value(TEXT).replace("eligible: [2]", "eligible: [5]"))
    page.until("document.querySelectorAll('#problems li').length === 1")
    page.click("#problems button")
    picked = page.value(
        "(f => f.value.slice(f.selectionStart, f.selectionEnd))(document.getElementById('text'))"
    )
    assert picked.strip() == "eligible: [5]"


def test_a_mission_is_downloaded_in_another_format(page: Page, tmp_path: Path) -> None:
    page.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path / "got"))
    data = json.loads(_downloaded(page, tmp_path / "got" / "crossing.geojson", "geojson"))
    assert page.text("exported-files") == "crossing.geojson; this format does not say:"
    assert "relations" in page.text("unsaid")
    assert {f["properties"]["kind"] for f in data["features"]} >= {"vehicle", "must_fly"}
    page.click("#plan")
    page.until("document.querySelectorAll('#gantt .bar').length === 2")
    flown = _downloaded(page, tmp_path / "got" / "crossing.waypoints", "qgc", vehicle=2)
    assert page.text("exported-files").startswith("crossing.waypoints, with the planned routes; ")
    assert flown.startswith("QGC WPL 110")
    assert len(flown.splitlines()) >= 4
    write(page, "text", page.value(TEXT).replace("east_m: 2500", "east_m: 2600"))
    # of another text than was planned, it is not the plan's way
    (tmp_path / "got" / "crossing.waypoints").unlink()
    other = _downloaded(page, tmp_path / "got" / "crossing.waypoints", "qgc", vehicle=2)
    assert other != flown
    assert page.text("exported-files").startswith("crossing.waypoints; ")
    assert page.logged == []


def _downloaded(page: Page, file: Path, form: str, vehicle: int | None = None) -> str:
    """What the browser has saved of an export, once it is whole."""
    page.value(
        f"(f => {{ f.value = '{form}'; f.dispatchEvent(new Event('change')); }})"
        "(document.getElementById('export-format'))"
    )
    if vehicle is not None:
        page.until("!document.getElementById('export-vehicle').hidden")
        page.value(f"document.getElementById('export-vehicle').value = '{vehicle}'")
    page.click("#export")
    until_s = time.monotonic() + 60
    while not file.exists():
        assert time.monotonic() < until_s
        time.sleep(0.05)
    return file.read_text(encoding="utf-8")
