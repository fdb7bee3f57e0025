"""The page of the mission editor as a user has it: what is typed, clicked and dragged, and what the text then says."""

from __future__ import annotations

from typing import Any

from chromium_tools import Page

from cratous.services.mission_editor.text_edits import MissionText

TEXT = "document.getElementById('text').value"


def write(page: Page, name: str, text: str) -> None:
    page.value(
        f"(f => {{ f.focus(); f.value = {text!r}; f.dispatchEvent(new Event('input')); }})"
        f"(document.getElementById({name!r}))"
    )


def click_map(page: Page, north: float, east: float) -> None:
    """Click where the map shows a place."""
    x, y = place(page, north, east)
    for kind in ("mousePressed", "mouseReleased"):
        page.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)


def place(page: Page, north: float, east: float) -> tuple[float, float]:
    """Pixels of a place: two points of the canvas say where they are."""
    box = page.value(
        "(b => [b.x, b.y, b.width, b.height])(document.getElementById('map').getBoundingClientRect())"
    )
    seen = []
    # away from the buttons and words that lie over the map
    for x, y in ((box[2] * 0.1, box[3] * 0.4), (box[2] * 0.9, box[3] * 0.8)):
        page.call("Input.dispatchMouseEvent", type="mouseMoved", x=box[0] + x, y=box[1] + y)
        words = page.text("cursor").replace(",", "").split()
        seen.append((x, y, float(words[1]), float(words[4])))
    (x0, y0, n0, e0), (x1, y1, n1, e1) = seen
    return (
        box[0] + x0 + (east - e0) / (e1 - e0) * (x1 - x0),
        box[1] + y0 + (north - n0) / (n1 - n0) * (y1 - y0),
    )


def data(page: Page) -> Any:
    return MissionText(page.value(TEXT), "the page").data


def drag_pixels(page: Page, at: tuple[float, float], to: tuple[float, float]) -> None:
    mouse = "Input.dispatchMouseEvent"
    page.call(mouse, type="mousePressed", x=at[0], y=at[1], button="left", clickCount=1)
    page.call(mouse, type="mouseMoved", x=to[0], y=to[1], button="left")
    page.call(mouse, type="mouseReleased", x=to[0], y=to[1], button="left", clickCount=1)
