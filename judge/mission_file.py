"""The mission from its YAML file, with the judge's own handling of units and paddings.

Paddings remain distances here, where the log has outlines with mitred corners. A file with a
`variation` gives another mission for every seed, so it is not accepted for a flown variant.
"""

from __future__ import annotations

import math
from pathlib import Path
from stat import S_ISREG
from typing import Any

import yaml

from cratous.judge import mission as m
from cratous.judge.declared import after_failure
from cratous.judge.earth import to_local
from cratous.judge.fields import Node
from cratous.judge.outlines import moved, moves, zone
from cratous.judge.sites import Fix, Site
from cratous.judge.views import in_file
from cratous.spec.errors import BadInput

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
"""The first is libyaml: ten times faster."""
LARGEST, DEPTH = 20_000_000, 100
CORNERS = 64
"""Number of corners of the polygon that encloses the circle of an area."""


def read(path: Path) -> m.Mission:
    """The mission in a file; BadInput if it is invalid."""
    try:
        kept = path.stat()
        if not S_ISREG(kept.st_mode):  # reading a pipe would block
            raise BadInput("not a regular file", where=str(path), expected="a mission file")
        if kept.st_size > LARGEST:
            raise BadInput("too large", where=str(path), expected=f"at most {LARGEST} bytes")
        text = path.read_text(encoding="utf-8")
        _refuse_deep(text)
        data = yaml.load(text, Loader=LOADER)
    except (OSError, UnicodeDecodeError, ValueError, yaml.YAMLError, RecursionError) as error:
        text = " ".join(str(error).split())[:200]
        raise BadInput(f"not a mission file ({text})", where=str(path)) from None
    root = Node(data, str(path), "mission")
    found = _Reader(root).mission()
    m.check(found, root)
    return found


def _refuse_deep(text: str) -> None:
    """Raise ValueError for nesting that would exhaust the stack, before parsing."""
    depth = 0
    for event in yaml.parse(text, Loader=LOADER):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > DEPTH:
                raise ValueError(f"nested in more than {DEPTH} levels")
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1


class _Reader:
    def __init__(self, root: Node) -> None:
        self.root, self.frame = root, root["frame"]
        self.terrain_m = self.frame.get("terrain_m", 0.0).real
        self.origin = self.frame["latitude_deg"].real, self.frame["longitude_deg"].real

    def mission(self) -> m.Mission:
        root = self.root
        zones = [self.zone(z, 0) for z in root.get("zones", []) if not moves(z)]
        drift = [self.drift(z) for z in root.get("zones", []) if moves(z)]
        said, ends = [], []
        for change in root.get("changes", []):
            at = _ms(change["at_s"])
            for name in m.CHANGES:
                if name == "zone" and change.has(name):
                    zones.append(self.zone(change[name], at))
                elif name == "zone_ends" and change.has(name):
                    ends.append((change[name], at))
                elif name not in m.ASK_NOTHING and change.has(name):
                    said.append((name, change[name].whole, at))
        vehicles = [self.vehicle(v) for v in root["vehicles"]]
        guarded = [v.id for v in vehicles if v.protected]
        bridge = root.get("bridge", {})
        count = bridge.get("instances", len(guarded)).whole
        volume = root.get("daa", {}).get("well_clear", {})
        usual = {"dthr_m": 150.0, "zthr_m": 30.0, "tthr_s": 15.0, "tcoa_s": 0.0}
        simulation = root.get("simulation", {})
        without_link = None
        if root.has("link_loss"):
            loss, fails = root["link_loss"], m.lines_fail(simulation.get("bridge_faults"), "_s")
            choice = loss["choice"].one_of(*m.CHOICES).capitalize()
            without_link = m.WithoutLink(choice, _ms(loss.get("after_s", 5)), fails)
        return m.Mission(
            name=root["name"].text,
            latitude_deg=self.origin[0],
            longitude_deg=self.origin[1],
            vehicles=m.by_id(vehicles, root["vehicles"]),
            tasks=m.by_id([self.task(t) for t in root["tasks"]], root["tasks"]),
            zones=(*m.with_ends(zones, ends), *drift),
            traffic=tuple(self.traffic(t) for t in root.get("traffic", [])),
            relations=root.get("relations", "").text,
            instances=frozenset(guarded[: max(count, 0)]),
            volume=m.Volume(*(volume.get(n, usual[n]).real for n in m.Volume._fields)),
            step_ms=m.positive(simulation.get("step_ms", 250)),
            heartbeat_ms=m.positive(simulation.get("heartbeat_ms", 500)),
            faulty_bridge=simulation.has("bridge_faults"),
            limit_ms=_ms(simulation.get("limit_s", 7200)),
            vehicle_said=m.said_of(said, "vehicle_joins", "vehicle_lost"),
            task_said=m.said_of(said, "task_added", "task_removed"),
            terrain_m=self.terrain_m,
            sites=tuple(self.site(one) for one in root.get("landing_sites", [])),
            without_link=without_link,
            after_failure=after_failure(root["on_failure"]) if root.has("on_failure") else None,
            fix=self.fix(root["merging"]) if root.has("merging") else None,
            senses=root.has("sensing"),
            lost_link_after_ms=_ms(bridge.get("lost_link_after_s", 30)),
            safe_state_after_ms=_ms(bridge.get("safe_state_after_s", 120)),
        )

    def fix(self, data: Node) -> Fix:
        """The fix at which vehicles merge."""
        who = frozenset(one.whole for one in data["vehicles"])
        place, apart_ms = self.point(data["fix"]["position"]), _ms(data.get("separation_s", 20))
        return Fix(data["fix"]["name"].text, *place, who, apart_ms, data["entry_m"].real)

    def site(self, data: Node) -> Site:
        """A landing site; its ground defaults to the terrain."""
        place = data["position"]
        ground = place.get("alt_m", self.terrain_m).real
        return Site(data["name"].text, *self.point(place), ground, data["radius_m"].real)

    def point(self, data: Node) -> m.Point:
        """A position in metres, in degrees, or as a pair of metres."""
        if isinstance(data.data, list):
            return m.pair(data)
        if data.has("latitude_deg"):
            local = to_local(*self.origin, data["latitude_deg"].real, data["longitude_deg"].real)
            if local is None:
                raise data.wrong("a place on this side of the Earth")
            return local
        return data["north_m"].real, data["east_m"].real

    def zone(self, data: Node, from_ms: int) -> m.Zone:
        plain: dict[str, Any] = {
            "id": data["id"].data,
            "kind": data["kind"].data,
            "vertices": [list(self.point(v)) for v in data["vertices"]],
            "floor_m": data.get("floor_m", -1000.0).data,
            "ceiling_m": data.get("ceiling_m", 100_000.0).data,
            "padding_m": data.get("padding_m", 0.0).data,
        }
        return zone(Node(plain, data.where, data.item), from_ms)

    def drift(self, data: Node) -> m.Zone:
        """A zone that moves; its times are its own."""
        until = _ms(data["until_s"]) if data.has("until_s") else None
        return moved(self.zone(data, _ms(data.get("from_s", 0))), data["velocity_m_s"], until)

    def vehicle(self, data: Node) -> m.Vehicle:
        cameras = tuple(
            m.Camera(
                c.get("payload_id", 1).whole, c.get("wavelength", "AllAny").text,
                c.get("pixels", 0).whole,
            )
            for c in data.get("cameras", [])
        )  # fmt: skip
        bank = math.radians(data.get("max_bank_deg", 30.0).real)
        protected = data.get("protected", True).flag
        ground = (
            self.ground(data["position"]) if data.get("start", "air").text == "ground" else None
        )
        speed = data["speed_m_s"].real
        fastest = data.get("max_speed_m_s", speed).real
        return m.Vehicle(data["id"].whole, protected, speed, bank, cameras, ground, fastest)

    def ground(self, data: Node) -> float:
        """Ground height at a place: of the first site there, otherwise the terrain."""
        place = self.point(data)
        for one in self.root.get("landing_sites", []):
            site = self.site(one)
            if math.dist(place, (site.north_m, site.east_m)) <= site.radius_m:
                return site.ground_m
        return self.terrain_m

    def task(self, data: Node) -> m.Task:
        kind = data["kind"].one_of(*m.KINDS)
        points = self.places(data)
        shape, radius, length = "", data.get("radius_m", 0.0).real, 0.0
        if data.has("loiter"):
            loiter = data["loiter"]
            shape, length = loiter.get("shape", "circular").text, loiter.get("length_m", 0.0).real
            radius = loiter.get("radius_m", radius).real
            if kind == "loiter" and loiter.has("centre"):
                points = (self.point(loiter["centre"]),)
        found = m.Task(
            id=data["id"].whole,
            kind=kind,
            points=points,
            eligible=frozenset(n.whole for n in data.get("eligible", [])),
            duration_ms=_ms(data.get("duration_s", 0)),
            standoff_m=data.get("standoff_m", 0.0).real,
            gsd_m=data.get("ground_sample_distance_m", 0.0).real,
            wavelength=data.get("wavelength", "AllAny").text,
            shape=shape,
            radius_m=radius,
            length_m=length,
            pattern=data.get("pattern", "").text,
            extent_m=data.get("extent_m", 0.0).real,
            views_deg=in_file(data),
        )
        m.check_task(found, data)
        return found

    def places(self, data: Node) -> tuple[m.Point, ...]:
        """Points, or the corners of a rectangle or of a polygon around a circle."""
        if data.has("rectangle"):
            shape = data["rectangle"]
            n, e = self.point(shape["centre"])
            turn = math.radians(shape.get("rotation_deg", 0.0).real)
            north, east = shape["height_m"].real / 2, shape["width_m"].real / 2
            along = math.cos(turn), math.sin(turn)
            return tuple(
                (n + a * along[0] - b * along[1], e + a * along[1] + b * along[0])
                for a, b in ((north, east), (-north, east), (-north, -east), (north, -east))
            )
        if data.has("circle"):
            (n, e), step = self.point(data["circle"]["centre"]), 2 * math.pi / CORNERS
            reach = data["circle"]["radius_m"].real / math.cos(step / 2)
            return tuple(
                (n + reach * math.cos(k * step), e + reach * math.sin(k * step))
                for k in range(CORNERS)
            )
        return tuple(self.point(p) for p in data["points"])

    def traffic(self, data: Node) -> m.Traffic:
        vanishes = _ms(data["vanishes_s"]) if data.has("vanishes_s") else None
        return m.Traffic(data["id"].whole, _ms(data.get("appears_s", 0)), vanishes)


def _ms(data: Node) -> int:
    """Seconds as milliseconds; non-negative."""
    if data.real < 0:
        raise data.wrong("0 or more")
    return round(data.real * 1000)
