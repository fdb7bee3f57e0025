"""Map and time line of a report as shapes in drawing units, for the template to write as SVG.

Everything comes from report.json; nothing is decided here. North is up, one scale in both
directions; y grows downwards as in SVG.
"""

from __future__ import annotations

from math import cos, floor, log10, pi, sin
from typing import Any

from cratous.services.certify.zone_positions import positions

MAP_WIDTH, MAP_HEIGHT, MAP_EDGE, MAP_FOOT = 640.0, 504.0, 40.0, 24.0
LETTER = (10.0, 19.0)
"""Maximum width and height of a letter on a narrow screen, in drawing units."""
BAR_LEFT, BAR_WIDTH, BAR_ROW = 110.0, 590.0, 46.0


class Scale:
    """Maps the mission frame [m] to the drawing."""

    def __init__(self, points: list[tuple[float, float]]) -> None:
        norths = [point[0] for point in points] or [0.0]
        easts = [point[1] for point in points] or [0.0]
        span_n = max(max(norths) - min(norths), 1.0)
        span_e = max(max(easts) - min(easts), 1.0)
        high = MAP_HEIGHT - MAP_FOOT  # the scale bar is drawn below the map
        self.factor = min((MAP_WIDTH - 2 * MAP_EDGE) / span_e, (high - 2 * MAP_EDGE) / span_n)
        self._north = (max(norths) + min(norths)) / 2
        self._east = (max(easts) + min(easts)) / 2

    def xy(self, north: float, east: float) -> tuple[float, float]:
        """Drawing coordinates of a position."""
        return (
            round(MAP_WIDTH / 2 + (east - self._east) * self.factor, 1),
            round((MAP_HEIGHT - MAP_FOOT) / 2 - (north - self._north) * self.factor, 1),
        )

    def line(self, places: list[Any]) -> str:
        """The `points` attribute of a polyline through positions that begin with north and east."""
        return " ".join("{},{}".format(*self.xy(place[0], place[1])) for place in places)


def _places(shape: list[dict[str, Any]]) -> list[tuple[float, float]]:
    return [(place["north_m"], place["east_m"]) for place in shape]


def _planned(report: dict[str, Any]) -> dict[int, list[tuple[float, float]]]:
    routes: dict[int, list[tuple[float, float]]] = {}
    for item in report["plan"]["items"]:
        route = routes.setdefault(item["vehicle_id"], [])
        route += _places(item["transit"]) + _places(item["path"])
    return routes


def map_view(report: dict[str, Any]) -> dict[str, Any]:
    """The map of a report: zones, tasks, planned routes, tracks coloured by commander, takeovers, scale and labels."""
    mission, flight = report["mission"], report["flight"]
    ours = [vehicle["id"] for vehicle in mission["vehicles"]]
    planned = _planned(report)
    tracks = {int(number): track for number, track in flight["tracks"].items()}
    flown = {number: [(row[1], row[2]) for row in track] for number, track in tracks.items()}
    shown = [place for route in planned.values() for place in route]
    shown += [place for number in ours for place in flown.get(number, [])]
    shown += [
        (point["north_m"], point["east_m"]) for task in mission["tasks"] for point in task["points"]
    ]
    shown += [(v["position"]["north_m"], v["position"]["east_m"]) for v in mission["vehicles"]]
    zones: list[tuple[Any, Any]] = [
        (zone, None) for zone in mission["zones"] if "moving" not in zone
    ]
    late = [(c["zone"], c["at_ms"] / 1000) for c in mission.get("changes", []) if c["zone"]]
    zones += [(zone, at_s) for zone, at_s in late if "moving" not in zone]
    drifting = [zone for zone in (*mission["zones"], *(z for z, _ in late)) if "moving" in zone]
    zones += positions(drifting, flight["end_ms"])
    ends = {c["zone_id"]: c["at_ms"] / 1000 for c in mission.get("changes", []) if "zone_id" in c}
    for zone, _ in zones:
        if zone["kind"] == "keep_out":
            shown += [(corner[0], corner[1]) for corner in zone["vertices"]]
    daa = mission.get("daa", {})
    lands = [daa.get(section) or {} for section in ("on_failure", "link_loss")]
    sites = next((one["sites"] for one in lands if one.get("sites")), ())
    shown += [(site["north_m"], site["east_m"]) for site in sites]
    merging = mission.get("daa", {}).get("merging")
    fixes = [] if merging is None else [{**merging, "radius_m": merging["entry_m"]}]
    shown += [(fix["north_m"], fix["east_m"]) for fix in fixes]
    scale = Scale(shown)
    tasks = [_task(task, scale) for task in mission["tasks"]]
    taken: list[Box] = []
    for task in tasks:
        task["said"] = _beside(task["x"], task["y"], f"p{task['id']}", taken)
    return {
        "width": MAP_WIDTH,
        "height": MAP_HEIGHT,
        "zones": [
            {
                "kind": zone["kind"],
                "id": zone["id"],
                "points": scale.line(zone["vertices"]),
                "from_s": from_s,
                "until_s": ends.get(zone["id"]),
                "at": scale.xy(*zone["vertices"][0]),
                "said": _said(zone, from_s, ends.get(zone["id"]), scale, taken),
            }
            for zone, from_s in zones
        ],
        "sites": [{"name": site["name"], **_hold(site, scale)} for site in sites],
        "fixes": [{"name": fix["name"], **_hold(fix, scale)} for fix in fixes],
        "tasks": tasks,
        "footprints": [
            {
                "color": ours.index(f["vehicle"]) % 6,
                "task": f["task"],
                "time_s": f["time_ms"] / 1000,
                "points": scale.line(f["corners"]),
            }
            for f in flight.get("footprints", ())
        ],
        "planned": [
            {"color": ours.index(number) % 6, "points": scale.line(route)}
            for number, route in sorted(planned.items())
        ],
        "holds": [_hold(item["hold"], scale) for item in report["plan"]["items"] if item["hold"]],
        "tracks": [
            _track(number, ours.index(number) % 6, tracks[number], scale)
            for number in ours
            if number in tracks
        ],
        "traffic": [
            {"id": number, "points": scale.line(_inside(flown[number], scale))}
            for number in sorted(flown)
            if number not in ours
        ],
        "takeovers": [
            {"x": x, "y": y, "vehicle": t["vehicle"], "time_s": t["from_ms"] / 1000}
            for t in flight["takeovers"]
            for x, y in [scale.xy(t["north_m"], t["east_m"])]
        ],
        "starts": [_start(vehicle, k % 6, scale) for k, vehicle in enumerate(mission["vehicles"])],
        "bar": _scale_bar(scale.factor),
    }


Box = tuple[float, float, float, float]


def _box(x: float, y: float, text: str) -> Box:
    """Bounding box of a text on a narrow screen: left, top, right, bottom."""
    return x, y - LETTER[1], x + LETTER[0] * len(text), y + 0.25 * LETTER[1]


def _beside(x: float, y: float, text: str, taken: list[Box]) -> dict[str, Any]:
    """A label beside a point, on the side where it overlaps no other; taken: boxes of labels,
    extended by this one.
    """
    left = x - 13 - LETTER[0] * len(text)
    sides = [(x + 13, y - 9), (x + 13, y + 22), (left, y - 9), (left, y + 22)]
    boxes = [_box(*side, text) for side in sides]
    k = next((k for k in range(4) if not any(_overlap(boxes[k], box) for box in taken)), 0)
    taken.append(boxes[k])
    return {"text": text, "x": round(sides[k][0], 1), "y": round(sides[k][1], 1)}


def _said(
    zone: dict[str, Any],
    from_s: float | None,
    until_s: float | None,
    scale: Scale,
    taken: list[Box],
) -> dict[str, Any] | None:
    """The label of when a zone appears or ends, placed inside the sheet without overlap; None for a
    zone that is always present. taken: boxes of labels, extended by this one.
    """
    if from_s is None and until_s is None:
        return None
    text = f"zone {zone['id']}"
    if "at_s" in zone:
        text, until_s = f"{text} at {zone['at_s']:g} s", None
    else:
        text += "" if from_s is None else f", from {from_s:g} s"
    text += "" if until_s is None else f", until {until_s:g} s"
    corners = [scale.xy(*corner) for corner in zone["vertices"]]
    left, high, low = (f(c[k] for c in corners) for f, k in ((min, 0), (min, 1), (max, 1)))
    x = max(4.0, min(left, MAP_WIDTH - 4 - LETTER[0] * len(text)))
    step = LETTER[1] + 4
    places = [y for k in range(8) for y in (high - 6 - k * step, low + LETTER[1] + k * step)]
    free = [y for y in places if not any(_overlap(_box(x, y, text), box) for box in taken)]
    y = next((y for y in free if LETTER[1] < y < MAP_HEIGHT - 4), places[0])
    taken.append(_box(x, y, text))
    return {"text": text, "x": round(x, 1), "y": round(y, 1)}


def _overlap(one: Box, other: Box) -> bool:
    apart = one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]
    return not apart


def _inside(places: list[tuple[float, float]], scale: Scale) -> list[tuple[float, float]]:
    """The part of a traffic track on or near the sheet."""
    kept = []
    for place in places:
        x, y = scale.xy(*place)
        if -MAP_WIDTH < x < 2 * MAP_WIDTH and -MAP_HEIGHT < y < 2 * MAP_HEIGHT:
            kept.append(place)
    return kept


def _task(task: dict[str, Any], scale: Scale) -> dict[str, Any]:
    places = _places(task["points"])
    x, y = scale.xy(*places[0])
    if task.get("kind") == "area_search":
        places.append(places[0])
    return {
        "id": task["id"],
        "label": task["label"],
        "x": x,
        "y": y,
        "lone": len(places) == 1,
        "points": scale.line(places),
        "radius": round((task["radius_m"] or task.get("extent_m", 0.0)) * scale.factor, 1),
    }


def _hold(hold: dict[str, Any], scale: Scale) -> dict[str, float]:
    x, y = scale.xy(hold["north_m"], hold["east_m"])
    return {"x": x, "y": y, "r": round(hold["radius_m"] * scale.factor, 1)}


def _track(number: int, color: int, track: list[list[float]], scale: Scale) -> dict[str, Any]:
    """A flown track split where the authority changes; segments share their end points."""
    pieces: list[dict[str, Any]] = []
    for row in track:
        if not pieces or pieces[-1]["owner"] != row[4]:
            start = [pieces[-1]["places"][-1]] if pieces else []
            pieces.append({"owner": row[4], "places": start})
        pieces[-1]["places"].append((row[1], row[2]))
    return {
        "vehicle": number,
        "color": color,
        "pieces": [
            {"icarous": piece["owner"] == 1, "points": scale.line(piece["places"])}
            for piece in pieces
        ],
    }


def _start(vehicle: dict[str, Any], color: int, scale: Scale) -> dict[str, Any]:
    x, y = scale.xy(vehicle["position"]["north_m"], vehicle["position"]["east_m"])
    heading = vehicle["heading_rad"]
    corners = []
    for angle, reach in ((0.0, 15.0), (2.6, 10.0), (-2.6, 10.0)):
        corners.append(
            f"{x + reach * sin(heading + angle):.1f},{y - reach * cos(heading + angle):.1f}"
        )
    away = heading + pi
    reach = 20 + 3.6 * len(vehicle["label"]) * abs(sin(away))
    return {
        "points": " ".join(corners),
        "color": color,
        "label": vehicle["label"],
        "id": vehicle["id"],
        "x": round(x + reach * sin(away), 1),
        "y": round(y - reach * cos(away), 1),
    }


def _scale_bar(factor: float) -> dict[str, Any]:
    metres = 120 / factor
    step = 10 ** floor(log10(metres))
    length = max(k * step for k in (1, 2, 5) if k * step <= metres)
    text = f"{length / 1000:g} km" if length >= 1000 else f"{length:g} m"
    return {"length": round(length * factor, 1), "text": text}


def time_view(report: dict[str, Any]) -> dict[str, Any]:
    """One row of bars per vehicle, with ticks in seconds."""
    flight = report["flight"]
    end_s = max(flight["end_ms"] / 1000, 1.0)
    vehicles = report["mission"]["vehicles"]
    rows = {vehicle["id"]: k for k, vehicle in enumerate(vehicles)}

    def x_of(time_ms: float) -> float:
        return round(BAR_LEFT + BAR_WIDTH * min(time_ms / 1000 / end_s, 1.0), 1)

    def placed(bars: list[dict[str, Any]]) -> list[dict[str, Any]]:
        return [
            {
                **bar,
                "x": x_of(bar["from_ms"]),
                "width": max(round(x_of(bar["to_ms"]) - x_of(bar["from_ms"]), 1), 1.0),
                "y": rows[bar["vehicle"]] * BAR_ROW,
            }
            for bar in bars
            if bar["vehicle"] in rows
        ]

    modes = [one for one in flight.get("modes", ()) if one["group"] != "nominal"]
    step = nice_step(end_s / 6)
    return {
        "width": BAR_LEFT + BAR_WIDTH + 30,
        "height": len(vehicles) * BAR_ROW + 34,
        "bottom": len(vehicles) * BAR_ROW,
        "rows": [
            {"label": vehicle["label"], "id": vehicle["id"], "y": k * BAR_ROW}
            for k, vehicle in enumerate(vehicles)
        ],
        "bars": placed(flight["bars"]),
        "modes": placed(modes),
        "ticks": [
            {"x": x_of(1000 * k * step), "text": f"{k * step:g} s"}
            for k in range(floor(end_s / step) + 1)
        ],
    }


def nice_step(least: float) -> float:
    """The smallest of 1, 2, 5, 10, 20 ... that is at least `least`."""
    power = 10 ** floor(log10(max(least, 1e-3)))
    return next(k * power for k in (1, 2, 5, 10) if k * power >= least)
