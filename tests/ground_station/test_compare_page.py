"""Two runs side by side in a real browser: what differs is marked, and a click moves both clocks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium_tools import Page, browsing
from ground_station_tools import serving

pytestmark = pytest.mark.slow
READY = "!document.getElementById('station')?.hidden && document.querySelector('#differences')"


@pytest.fixture
def page(crossing: Path, crossing_alone: Path, tmp_path: Path) -> Iterator[Page]:
    with serving(crossing, crossing_alone) as (_, port), browsing(tmp_path) as page:
        page.go(f"http://127.0.0.1:{port}/#t=0&theme=light")
        page.until(READY)
        yield page
        # nothing was refused by the content security policy, no script failed
        assert page.logged == []


def _row(page: Page, what: str) -> str:
    """The script that gives the row of the differences whose first cell begins so."""
    return (
        "[...document.querySelectorAll('#differences tr')]"
        f".find(row => row.firstChild.textContent.startsWith({what!r}))"
    )


def _cells(page: Page, what: str) -> list[str]:
    found = page.value(f"[...{_row(page, what)}.children].map(one => one.textContent)")
    assert isinstance(found, list)
    return found


def test_takeover_and_verdict_are_marked_and_a_click_moves_the_clock(page: Page) -> None:
    assert page.text("overall-a") == "holds"
    assert page.text("overall-b") == "violated"
    what, a, b = _cells(page, "G2 Well clear")
    assert what.endswith("different")
    assert a == "99.3 s holds, 70.54 m"
    assert b == "83.5 s violated, -148.9 m"
    what, a, b = _cells(page, "takeover of vehicle 2")
    assert what.endswith("only A")
    assert a.startswith("21.5 s traffic: loss predicted in 57.9 s")
    assert b == "–"
    for name, cell in (("takeover of vehicle 2", 1), ("G2 Well clear", 2)):
        button = f"{_row(page, name)}.children[{cell}].querySelector('button')"
        page.value(f"{button}.id = 'wanted-{cell}'")
        page.click(f"#wanted-{cell}")
        at = "00:00:21.5" if cell == 1 else "00:01:23.5"
        assert page.text("clock") == f"{at} of 00:03:40.8"
        assert page.value(f"{_row(page, name)}.className") == "near"
        under = "ICAROUS since 21.5 s" if cell == 1 else "UxAS"
        assert f"2 Merlin: {under}" in page.text("now-a")
        assert page.text("now-b").endswith("2 Merlin: UxAS")
    assert page.value("location.hash").startswith("#t=83.5&rate=1")


def _orange(page: Page, name: str) -> int:
    """Pixels of a canvas in the colour of ICAROUS."""
    found = page.value(f"""(() => {{
        const map = document.querySelector('#{name} .drawing'), pen = map.getContext('2d');
        const pixels = pen.getImageData(0, 0, map.width, map.height).data;
        let found = 0;
        for (let k = 0; k < pixels.length; k += 4)
            found += pixels[k] === 0xc9 && pixels[k + 1] === 0x44 && pixels[k + 2] === 0;
        return found;
    }})()""")
    return int(found)


def test_one_clock_moves_both_maps_and_says_which_flight_has_ended(page: Page) -> None:
    page.value("location.hash = '#t=34&theme=light'")
    page.until("document.getElementById('clock').textContent.startsWith('00:00:34.0')")
    assert _orange(page, "map-a") > 100
    assert _orange(page, "map-b") == 0
    page.key("+")
    page.until("location.hash.includes('map=')")
    page.key("f")
    for _ in range(6):
        page.key("]")
    page.value(
        "window.said = []; new MutationObserver(() => window.said.push(document.getElementById('play').textContent))"
        ".observe(document.getElementById('play'), { childList: true, characterData: true, subtree: true })"
    )
    page.key(" ")
    page.until("window.said.includes('Pause')")  # it may be at the end by now
    page.until("document.getElementById('play').textContent === 'Play'")
    assert page.text("clock") == "00:03:40.8 of 00:03:40.8"
    assert page.text("now-b").endswith("the flight ended at 214.3 s")
    assert "ended" not in page.text("now-a")
    page.click("#altitude-b")
    # the middle of the canvas, left of which the scale stands
    assert 80 < float(page.value("document.getElementById('slider').value")) / 1000 < 108


def test_events_of_one_run_alone_are_marked_in_both_lists(page: Page) -> None:
    marked = "[...document.querySelectorAll('#events-{} .differs')].map(one => one.textContent)"
    of_a, of_b = page.value(marked.format("a")), page.value(marked.format("b"))
    assert any("ICAROUS takes over because of 1" in text for text in of_a)
    assert not any("task 1" in text for text in of_a + of_b)
    assert [text for text in of_b if "complete" in text] == [
        "214.1 s  vehicle 2: task 2: complete",
        "214.3 s  end of mission: complete",
    ]


def test_both_panes_are_made_of_one(page: Page) -> None:
    script = (
        "['a', 'b'].map(side => [...document.getElementById(`map-${side}`).closest('.pane')"
        ".querySelectorAll('[id], [aria-label]')].map(one => [one.tagName, one.id, one.ariaLabel]))"
    )
    one, two = page.value(script)
    assert len(one) == 7
    turned = [
        [t, i[:-1] + "b", label and label.replace("run A", "run B").replace("Run A", "Run B")]
        for t, i, label in one
    ]
    assert two == turned
    assert page.value("document.querySelectorAll('.pane').length") == 2
    assert sum("un A" in (label or "") for _, _, label in one) == 3
    assert page.value("[...document.querySelectorAll('.side')].map(one => one.textContent)") == [
        "A",
        "B",
    ]


def test_where_verdicts_are_not_compared_the_page_says_so(
    crossing: Path, crossing_alone: Path, tmp_path: Path
) -> None:
    with serving(crossing, crossing_alone / "log.sqlite") as (_, port), browsing(tmp_path) as page:
        page.go(f"http://127.0.0.1:{port}/")
        page.until(READY)
        note = page.text("differences-note")
        assert "Verdicts are not compared. B: there is no report.json" in note
        assert "verdicts and margins" not in note
        assert "The digests of the logs are not the same." in note
        assert "G2" not in page.text("differences")
        assert page.text("overall-b") == "not judged"


def test_a_run_beside_itself_differs_in_nothing(crossing: Path, tmp_path: Path) -> None:
    with serving(crossing, crossing) as (_, port), browsing(tmp_path) as page:
        page.go(f"http://127.0.0.1:{port}/")
        page.until(READY)
        assert page.text("count") == "(0)"
        note = page.text("differences-note")
        assert note.startswith("None in what is compared. Both logs have the same digest.")
        assert "once a second, to 0.1 m" in note
        assert page.value("document.querySelectorAll('.differs, #differences tr').length") == 0
        assert page.logged == []
