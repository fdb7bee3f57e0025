"""Map, altitudes, distances and time line of a report as shapes; the content is that of report.html."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cratous.services.certify.charts import altitude_view, separation_view
from cratous.services.certify.html import seconds
from cratous.services.certify.picture import BAR_ROW, map_view, time_view
from cratous.services.full_report.document import Beside, Picture, Words
from cratous.services.full_report.shapes import Disc, Label, Line, Shape, box, places

Data = dict[str, Any]
NAMED = 6
"""Maximum number of curves named below a plot."""
ROWS = 20
"""Maximum number of vehicles in one time line, as fit on a page."""
NORTH = ((0.0, 0.0), (9.0, 26.0), (0.0, 20.0), (-9.0, 26.0))


def flight_pictures(report: Data) -> Beside:
    """The map, with the altitude and distance plots beside it, as far as they exist."""
    charts = [one for one in (_altitudes(report), _distances(report)) if one is not None]
    return Beside(_map(report), tuple(charts))


def _map(report: Data) -> Picture:
    view = map_view(report)
    caption = [("planned", "planned 0"), ("flown, UxAS in command (a colour a vehicle)", "track 0"),
               ("flown, ICAROUS in command", "icarous"), ("takeover", "takeover"), ("task", "taskline")]  # fmt: skip
    for key, said, style in (
        ("traffic", "traffic", "traffic"), ("zones", "keep-out", "keep_out"),
        ("zones", "keep-in", "keep_in"), ("footprints", "some of the footprints", "footprint 0"),
        ("sites", "landing site", "site"), ("holds", "loiter", "hold"),
        ("fixes", "entry zone of the merge fix", "hold"),
    ):  # fmt: skip
        caption += [(said, style)] if view[key] else []
    return Picture("Map", view["width"], view["height"], tuple(_map_shapes(view)), tuple(caption))


def _map_shapes(view: Data) -> Iterator[Shape]:
    for zone in view["zones"]:
        yield Line(places(zone["points"]), zone["kind"], closed=True)
        said = [f"from {zone['from_s']} s"] if zone["from_s"] is not None else []
        said += [f"until {zone['until_s']} s"] if zone["until_s"] is not None else []
        x, y = zone["at"]
        yield Label((x, y - 6), ", ".join((f"zone {zone['id']}", *said)), soft=True)
    for site in view["sites"]:
        yield Disc((site["x"], site["y"]), site["r"], "site")
        yield Label((site["x"] + site["r"] + 4, site["y"] + 4), site["name"], soft=True)
    for fix in view["fixes"]:
        yield Disc((fix["x"], fix["y"]), fix["r"], "hold")
        yield Label((fix["x"] + fix["r"] + 4, fix["y"] + 4), fix["name"], soft=True)
    for task in view["tasks"]:
        x, y = task["x"], task["y"]
        if task["radius"]:
            yield Disc((x, y), task["radius"], "hold")
        diamond = ((x, y - 9), (x + 9, y), (x, y + 9), (x - 9, y))
        if task["lone"]:
            yield Line(diamond, "taskpoint", closed=True)
        else:
            yield Line(places(task["points"]), "taskline")
    for one in view["footprints"]:
        yield Line(places(one["points"]), f"footprint {one['color']}", closed=True)
    for one in view["planned"]:
        yield Line(places(one["points"]), f"planned {one['color']}")
    for one in view["holds"]:
        yield Disc((one["x"], one["y"]), one["r"], "hold")
    for one in view["traffic"]:
        yield Line(places(one["points"]), "traffic")
    for track in view["tracks"]:
        for piece in track["pieces"]:
            style = "icarous" if piece["icarous"] else f"track {track['color']}"
            yield Line(places(piece["points"]), style)
    for one in view["takeovers"]:
        yield Disc((one["x"], one["y"]), 6.0, "takeover")
    for one in view["starts"]:
        yield Line(places(one["points"]), f"start {one['color']}", closed=True)
        yield Label((one["x"], one["y"] + 5), one["label"], "middle")
    for task in view["tasks"]:
        yield Label((task["x"] + 13, task["y"] - 9), f"p{task['id']}", soft=True)
    x, y = view["width"] - 32, 16.0
    yield Line(tuple((x + a, y + b) for a, b in NORTH), "needle", closed=True)
    yield Label((x, y + 44), "N", "middle")
    x, y, length = 24.0, view["height"] - 22, view["bar"]["length"]
    for end in (x, x + length):
        yield Line(((end, y - 5), (end, y + 5)), "ink")
    yield Line(((x, y), (x + length, y)), "ink")
    yield Label((x + length + 10, y + 5), view["bar"]["text"])


def _axes(view: Data) -> Iterator[Shape]:
    for one in view["levels"]:
        yield Line(((view["left"], one["y"]), (view["right"], one["y"])), "rule")
        yield Label((view["left"] - 6, one["y"] + 4), one["text"], "end", soft=True)
    for one in view["times"]:
        yield Line(((one["x"], view["top"]), (one["x"], view["bottom"])), "rule")
        yield Label((one["x"], view["bottom"] + 18), one["text"], "middle", soft=True)


def _altitudes(report: Data) -> Picture | None:
    view = altitude_view(report)
    if view is None:
        return None
    curves = view["curves"]
    shapes = [*_axes(view), *(Line(places(c["points"]), f"track {c['color']}") for c in curves)]
    caption = [
        (f"{c['label']} {c['low_m']} to {c['high_m']} m", f"track {c['color']}")
        for c in curves[:NAMED]
    ]
    of = "" if len(curves) <= NAMED else f" (the first {NAMED} of {len(curves)} vehicles are named)"
    title = f"Altitude above mean sea level{of}"
    return Picture(title, view["width"], view["height"], tuple(shapes), tuple(caption))


def _distances(report: Data) -> Picture | None:
    view = separation_view(report)
    if view is None:
        return None
    left, right, y = view["left"], view["right"], view["dthr_y"]
    shapes = [*_axes(view), Line(((left, y), (right, y)), "threshold")]
    caption = []
    for c in view["curves"]:
        shapes += [Line(places(c["points"]), f"track {c['color']}"), Disc(c["at"], 3.0, "takeover")]
        said = (
            f"{c['pair']}: {c['least_m']} m at {seconds(c['time_ms'])}, {c['above_m']} m vertically"
        )
        caption.append((said, f"track {c['color']}"))
    caption.append((f"threshold DTHR, {view['dthr_m']:g} m", "threshold"))
    shown, pairs = len(view["curves"]), view["pairs"]
    of = "" if shown == pairs else f" (the nearest {shown} of {pairs} pairs)"
    title = f"Closest approaches, horizontally, from one row a second{of}"
    return Picture(title, view["width"], view["height"], tuple(shapes), tuple(caption))


def time_line(report: Data) -> tuple[Picture | Words, ...]:
    """What each vehicle did over time, ROWS vehicles per picture; a text if no bar can be drawn."""
    view = time_view(report)
    if not view["bars"]:
        return (Words("Time line: not observed.", "soft"),)
    count = len(view["rows"])
    return tuple(_rows(view, k, min(k + ROWS, count)) for k in range(0, count, ROWS))


def _rows(view: Data, begin: int, end: int) -> Picture:
    """The time line of the vehicles of rows `begin` to `end` (exclusive)."""
    top, bottom = begin * BAR_ROW, (end - begin) * BAR_ROW
    shapes: list[Shape] = []
    for tick in view["ticks"]:
        shapes.append(Line(((tick["x"], 0.0), (tick["x"], bottom)), "rule"))
        shapes.append(Label((tick["x"], bottom + 20), tick["text"], "middle", soft=True))
    for row in view["rows"][begin:end]:
        shapes.append(Label((4.0, row["y"] - top + BAR_ROW / 2), row["label"]))
    for bar in view["bars"]:
        y = bar["y"] - top
        if 0 <= y < bottom:
            # the commander is drawn in a row below the activity
            high, down = (8.0, 30.0) if bar["what"] == "icarous" else (20.0, 10.0)
            corners = box(bar["x"], y + down, bar["width"], high)
            shapes.append(Line(corners, f"bar {bar['what']}", closed=True))
    named = (("on the way", "bar transit"), ("waits (loiters)", "bar wait"), ("task", "bar task"),
             ("task suspended, returns to it", "bar return"), ("ICAROUS in command", "bar icarous"))  # fmt: skip
    count, foot = len(view["rows"]), view["height"] - view["bottom"]
    of = "" if count <= ROWS else f", vehicles {begin + 1} to {end} of {count}"
    return Picture(f"Time line{of}", view["width"], bottom + foot, tuple(shapes), named)
