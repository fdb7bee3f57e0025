"""Draws `docs/img/flown_cordon.svg` and `docs/img/flown_moving.svg`.

    PYTHONPATH=src:tests/tools python docs/tools/moving_tasks.py

All tracks shown are simulated: complete requests to `cratous uxas`, with the vehicles of `cratous sim`, in one
process and in virtual time. The same code gives the same files.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import matplotlib as mpl

mpl.use("svg")
from following_tools import ENTITY, aircraft
from matplotlib import pyplot as plt
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar
from pipeline_tools import PIPELINE, must_fly, place, request
from rendezvous_tools import meeting
from uxas_flight import Flight, fly, local
from uxas_tools import process, write_cfg

from cratous.bridge import lmcp
from cratous.core.files.whole_file import replacing
from cratous.services.simulator import scenario
from cratous.services.simulator.world import Event, World
from cratous.services.uxas.manager import startup

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "img"
HEARD = ("afrl.cmasi.AutomationResponse", "afrl.cmasi.VehicleActionCommand")
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")
CAR = (0.03, 0.002)
STREET = ((0.034, 0.002), (0.034, 0.014), (0.055, 0.014))
"""CAR is the start of the watched vehicle, STREET the corners of its route."""
mpl.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "moving", "font.size": 8})


class Panel(NamedTuple):
    """title; flight; marks: places with their names; rings: places with a radius [m]."""

    title: str
    flight: Flight
    marks: tuple[tuple[Any, str], ...] = ()
    rings: tuple[tuple[Any, float], ...] = ()


def car() -> list[Any]:
    """A car that drives along a street at 6 m/s, and its plan."""
    ways = [
        lmcp.new("Waypoint", Number=k, NextWaypoint=k + 1, Speed=6.0, **_at(p))
        for k, p in enumerate(STREET, 1)
    ]
    return [
        lmcp.new("GroundVehicleConfiguration", ID=ENTITY, NominalSpeed=6.0, MaximumSpeed=8.0),
        lmcp.new("GroundVehicleState", ID=ENTITY, Location=lmcp.new("Location3D", **_at(CAR))),
        lmcp.new("MissionCommand", CommandID=1, VehicleID=ENTITY, FirstWaypoint=1, WaypointList=ways),
    ]  # fmt: skip


def _at(point: Sequence[float]) -> dict[str, float]:
    return {"Latitude": point[0], "Longitude": point[1]}


SOUTH = ((0.018, -0.004), (0.018, 0.006))
WEST = ((0.0, 0.0), (0.004, -0.02), (0.012, -0.03))


def flown(task: Any, seconds: float, *more: Any, starts: Sequence[Any] = SOUTH[:1]) -> Flight:
    """Fly a task with aircraft at given starting places; a car drives, unless the aircraft come from the west."""
    bodies = list[Any]() if starts is WEST else car()
    numbers = tuple(range(1, len(starts) + 1))
    for n, at in zip(numbers, starts, strict=True):
        configuration, state = aircraft(n, 0.0)
        bodies += [configuration.copy(MinimumSpeed=15.0), state.copy(Location=place(*at))]
    events = [Event(0.1 * k, body, "") for k, body in enumerate(bodies)]
    said = [(1.0, one) for one in (*more, task)]
    said.append((3.0, request(task.TaskID, vehicles=numbers)))
    text = "\n".join(f'<Service Type="{kind}"/>' for kind in PIPELINE)
    with TemporaryDirectory() as folder:
        return fly(write_cfg(Path(folder), text), events, seconds, said, HEARD)


def lasting(seconds: int) -> list[Any]:
    """The parameter for the duration of a task."""
    return [lmcp.new("KeyValuePair", Key="Duration_ms", Value=str(1000 * seconds))]


def cordon() -> Flight:
    """The flight of the example, unchanged except for its bridge."""
    with TemporaryDirectory() as name:
        folder = shutil.copytree(ROOT / "examples" / "cordon", Path(name) / "cordon")
        cfg = folder / "cfg_driven.xml"
        text = re.sub(r"<Bridge.*?</Bridge>", "", cfg.read_text(), flags=re.DOTALL)
        text = re.sub(r'<Service Type="(AutomationDiagram|Test_)\w+"/>', "", text)
        with replacing(cfg) as part:
            part.write_text(text)
        return fly(cfg, scenario.read(folder / "scenario.xml").events, 760.0, (), HEARD)


def together(seconds: float) -> Flight:
    """Two processes, each with one vehicle, plan a request together, and each flies its own vehicle's part."""
    numbers, flight = (1, 2), Flight([])
    original = request(5, 6, 7, 8, vehicles=numbers)
    asked = lmcp.new("CoordinatedAutomationRequest", RequestID=7, MaximumResponseTime=5000,
                     OriginalRequest=original)  # fmt: skip
    points = [must_fly(k, *p) for k, p in zip((5, 6, 7, 8), CORNERS, strict=True)]
    bodies = [b for n in numbers for b in aircraft(n, 0.01 * n - 0.01)]
    world = World([Event(0.0, body, "") for body in bodies], seconds)
    text = "\n".join(f'<Service Type="{kind}"/>' for kind in PIPELINE)
    with TemporaryDirectory() as name:
        ends, waiting = dict[int, Any](), list[tuple[int, Any]]()
        for n in numbers:
            (Path(name) / str(n)).mkdir()
            cfg = write_cfg(Path(name) / str(n), text, entity=n)
            one = ends[n] = process(cfg, virtual=True)[0]
            one.bus.tap(lambda e, n=n: waiting.append((n, e)))
            startup(one.bus)
        said = [(1.0, [*points, lmcp.new("AssignmentCoordinatorTask", TaskID=9)]), (3.0, [asked])]
        while not world.over:
            told = world.tick()
            if said and said[0][0] <= world.time_s:
                told += said.pop(0)[1]
            for one in ends.values():
                for body in told:
                    one.bus.publish(body, "outside")
                one.bus.run_until(int(world.time_s * 1000))
            flight.told.extend((world.time_s, e) for n, e in waiting if n == 1)
            for n, e in waiting:
                kind = type(e.body).__name__
                if kind == "AssignmentCoordination" and e.source != "outside":
                    ends[3 - n].bus.publish(e.body, "outside")
                elif kind == "AutomationResponse":
                    own = [c for c in e.body.MissionCommandList if c.VehicleID == n]
                    world.receive(e.body.copy(MissionCommandList=own))
            waiting.clear()
        for one in ends.values():
            one.close()
    return flight


CORNERS = ((0.03, -0.015), (0.045, -0.01), (0.03, 0.018), (0.05, 0.012))


def moving() -> list[Panel]:
    """The panels of the tasks that follow moving objects, and of those for several vehicles."""
    watch = lmcp.new("WatchTask", TaskID=5, WatchedEntityID=ENTITY, DwellTime=120_000)
    several = lmcp.new("MultiVehicleWatchTask", TaskID=5, WatchedEntityID=ENTITY,
                       DwellTime=120_000, NumberVehicles=2)  # fmt: skip
    escort = lmcp.new("EscortTask", TaskID=5, SupportedEntityID=ENTITY, StandoffDistance=250.0,
                      Parameters=lasting(180))  # fmt: skip
    kept = place(0.05, 0.014)
    blockade = lmcp.new("BlockadeTask", TaskID=5, BlockedEntityID=ENTITY, NumberVehicles=2,
                        StandoffDistance=600.0, ProtectedLocation=kept, Parameters=lasting(120))  # fmt: skip
    tower_at = place(0.032, -0.008)
    tower = lmcp.new("RadioTowerConfiguration", ID=21, Position=tower_at, Range=2_200.0)
    relay = lmcp.new("CommRelayTask", TaskID=5, SupportedEntityID=ENTITY, TowerID=21,
                     Parameters=lasting(150))  # fmt: skip
    met = meeting(1, 2, 3)
    states = tuple((s.PlanningPosition, f"{s.EntityID}") for s in met.RendezvousStates)
    points = tuple((place(*p), f"p{k}") for k, p in enumerate(CORNERS, 5))
    return [
        Panel("WatchTask of a car", flown(watch, 420.0)),
        Panel("MultiVehicleWatchTask, by two", flown(several, 420.0, starts=SOUTH)),
        Panel("EscortTask, 250 m ahead", flown(escort, 600.0)),
        Panel("BlockadeTask, by two", flown(blockade, 420.0, starts=SOUTH), ((kept, "protected"),)),
        Panel("CommRelayTask", flown(relay, 420.0, tower), ((tower_at, "tower"),),
              ((tower_at, 2_200.0),)),
        Panel("RendezvousTask of three", flown(met, 420.0, starts=WEST), states),
        Panel("AssignmentCoordinatorTask: two processes", together(330.0), points),
        Panel("CordonTask", cordon()),
    ]  # fmt: skip


def draw(axis: Any, panel: Panel, streets: bool = False, bar_m: int = 500) -> None:
    """Draw one flight: the tracks, thick while the vehicle's task was active, and the time of its completion."""
    flight = panel.flight
    told = [b for b in flight.of("AirVehicleState") + flight.of("GroundVehicleState") if b.Time]
    origin = told[0].Location
    done = {b.TaskID: b.TimeTaskCompleted for b in flight.of("TaskComplete")}
    ends_ms = max(done.values(), default=told[-1].Time)
    begins = {b.EntityID: b.TimeTaskActivated for b in reversed(flight.of("TaskActive"))}
    if streets:
        _streets(axis, origin)
    for k, vehicle in enumerate(sorted({b.ID for b in told})):
        states = [b for b in told if vehicle == b.ID and b.Time <= ends_ms][::3]
        way = local([b.Location for b in states], origin)
        colour = "#555555" if vehicle == ENTITY else COLOURS[k % len(COLOURS)]
        style = "--" if vehicle == ENTITY else "-"
        _line(axis, way, colour, style, 0.8)
        while_active = [p for p, b in zip(way, states, strict=True)
                        if begins.get(vehicle, ends_ms) <= b.Time]  # fmt: skip
        _line(axis, while_active, colour, style, 2.0)
        axis.plot(way[0].y, way[0].x, "o", color=colour, ms=4)
        axis.plot(way[-1].y, way[-1].x, "s", color=colour, ms=5)
        name = "car" if vehicle == ENTITY else str(vehicle)
        axis.annotate(name, (way[0].y, way[0].x), xytext=(4, 3), textcoords="offset points")
    for at, name in panel.marks:
        (p,) = local([at], origin)
        axis.plot(p.y, p.x, "^", color="#222222", ms=5)
        axis.annotate(name, (p.y, p.x), xytext=(4, 3), textcoords="offset points")
    for at, radius in panel.rings:
        (p,) = local([at], origin)
        axis.add_patch(plt.Circle((p.y, p.x), radius, fill=False, ls=":", color="#222222"))
    when = f"complete after {ends_ms / 1000:.0f} s" if done else "not complete"
    axis.set_title(f"{panel.title}\n{when}", fontsize=8)
    axis.set_aspect("equal", "datalim")
    axis.margins(0.08)
    axis.set(xticks=[], yticks=[])
    bar = AnchoredSizeBar(axis.transData, bar_m, f"{bar_m} m", "lower left", frameon=False)
    axis.add_artist(bar)


def _line(axis: Any, way: Sequence[Any], colour: str, style: str, width: float) -> None:
    axis.plot(
        [round(p.y, 1) for p in way], [round(p.x, 1) for p in way], style, color=colour, lw=width
    )


def _streets(axis: Any, origin: Any) -> None:
    """Draw the roads of the example's map."""
    text = (ROOT / "examples" / "cordon" / "roads.osm").read_text()
    nodes = {
        number: lmcp.new("Location3D", Latitude=float(lat), Longitude=float(lon))
        for number, lat, lon in re.findall(
            r'<node id="(-?\d+)" lat="([-.\d]+)" lon="([-.\d]+)"', text
        )
    }
    for way in re.findall(r"<way.*?</way>", text, flags=re.DOTALL):
        line = local([nodes[n] for n in re.findall(r'ref="(-?\d+)"', way)], origin)
        _line(axis, line, "#d5d5d5", "-", 3.0)


def cordon_near(panel: Panel) -> Any:
    """Draw the cordon as driven: all routes, and the blocked places magnified."""
    figure, (whole, near) = plt.subplots(1, 2, figsize=(9, 5))
    middle = next(b.CordonLocation for b in panel.flight.of("CordonTask"))
    for axis, bar_m in ((whole, 500), (near, 50)):
        draw(axis, panel._replace(rings=((middle, 100.0),)), streets=True, bar_m=bar_m)
    origin = next(b for b in panel.flight.of("GroundVehicleState") if b.Time).Location
    (p,) = local([middle], origin)
    for axis in (whole, near):
        axis.set_aspect("equal", "box")
    whole.set_title("four cars from their starts (dots) to their places (squares)", fontsize=8)
    near.set(xlim=(p.y - 150, p.y + 150), ylim=(p.x - 150, p.x + 150))
    near.set_title("the circle of 100 m about the place, and who blocks its roads", fontsize=8)
    return figure


def save(figure: Any, name: str) -> None:
    """Write a figure as SVG, identical for the same flight."""
    with replacing(FOLDER / name) as part:
        figure.savefig(part, format="svg", metadata={"Date": None}, bbox_inches="tight")
    plt.close(figure)


def main() -> None:
    """Fly all scenarios, and draw them."""
    panels = moving()
    figure, axes = plt.subplots(2, 4, figsize=(12, 6.8))
    for axis, panel in zip(axes.flat, panels, strict=True):
        draw(axis, panel, streets=panel.title == "CordonTask")
    figure.tight_layout()
    save(figure, "flown_moving.svg")
    save(cordon_near(panels[-1]), "flown_cordon.svg")


if __name__ == "__main__":
    main()
