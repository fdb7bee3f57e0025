"""Every parameter that ICAROUS and detect and avoid use for a mission: given, defaulted, derived or fixed.

Parameters that may be given have their default and range in the mission's JSON Schema. Derived ones are
computed by the functions used in flight (`services.icarous.derived`): here at cruise speed, in flight at the
present speed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from math import degrees
from pathlib import Path
from typing import Any

from cratous.core.avoidance.manoeuvre import PIECE_S
from cratous.core.avoidance.resolution import KEEP_RAD, STEP_DEG
from cratous.core.excuse import record
from cratous.services.icarous import return_to_path, traffic_monitor
from cratous.services.icarous.derived import derived
from cratous.services.icarous.foresight import ON_PATH_M, PASSED_S, REACHED_S
from cratous.services.icarous.instance import LINK_LOST_MS
from cratous.services.icarous.proposal import STEPS
from cratous.services.icarous.route_end import TRACKING_S, TURN_MARGIN, WIDEST
from cratous.services.icarous.traffic_monitor import TURNING_RAD_S
from cratous.services.loading.document import read_document
from cratous.services.loading.schema import mission_schema
from cratous.services.loading.yaml_mission import MAX_BANK_DEG, MAX_CLIMB_M_S
from cratous.services.mission.ground import GROUND_MARGIN, floor_of
from cratous.services.mission.guidance import guidance_of
from cratous.services.mission.landing import MAX_ACCELERATION_M_S2
from cratous.services.mission.leg_bounds import LONGEST_LOOKAHEADS, MOST_TAKEOVERS
from cratous.services.parameters.landing import landing_rows
from cratous.services.parameters.merging import merging_rows
from cratous.services.parameters.parameter import DEFAULT, DERIVED, FIXED, GIVEN, Parameter
from cratous.services.parameters.sensed import SECTION, rows_of
from cratous.services.parameters.take_off import take_off_rows
from cratous.spec.mission import Mission, Vehicle

UNITS = {
    "_m_s2": "m/s^2",
    "_m_s": "m/s",
    "_deg": "deg",
    "_ms": "ms",
    "_m": "m",
    "_s": "s",
    "_w": "W",
}
VEHICLE = ("speed_m_s", "min_speed_m_s", "max_speed_m_s", "max_bank_deg", "max_climb_m_s")
CRUISE = "the vehicle's speed_m_s"
EXCUSE = "whether there was a way out (G2) is looked for so among"


def parameters_of(mission: Mission, path: Path) -> tuple[Parameter, ...]:
    """All parameters of a mission read from a path, those of the mission first. Raises BadInput if it cannot
    be read again.
    """
    written = _written(path)
    rows = [*_of_mission(mission, written), *_of_sensing(mission, written)]
    rows += [*_of_link_loss(mission, written), *merging_rows(mission, written)]
    for k, vehicle in enumerate(mission.vehicles):
        rows += _of_vehicle(vehicle, _at(written, ("vehicles", k)))
        if vehicle.id in mission.instances:
            rows += [*_derived(mission, vehicle), *landing_rows(mission, vehicle)]
            rows += take_off_rows(mission, vehicle)
    return (*rows, *_fixed())


def _written(path: Path) -> Any:
    """The mission file's contents as plain data; None for a mission in messages."""
    if path.is_dir() and (path / "mission.yaml").is_file():
        path = path / "mission.yaml"
    return read_document(path).data if path.suffix.lower() in (".yaml", ".yml") else None


def _at(data: Any, key: tuple[str | int, ...]) -> Any:
    for part in key:
        inside = isinstance(data, list) or (isinstance(data, dict) and part in data)
        data = data[part] if inside else None
    return data


def _of_mission(mission: Mission, written: Any) -> Iterator[Parameter]:
    daa, simulation = mission.daa, mission.simulation
    guidance = guidance_of(daa.well_clear)
    for section, name, value in (
        ("daa.well_clear", "dthr_m", daa.well_clear.dthr_m),
        ("daa.well_clear", "zthr_m", daa.well_clear.zthr_m),
        ("daa.well_clear", "tthr_s", daa.well_clear.tthr_s),
        ("daa.well_clear", "tcoa_s", daa.well_clear.tcoa_s),
        ("daa", "lookahead_s", daa.lookahead_s),
        ("daa", "buffer", daa.buffer),
        ("daa", "close_starts", daa.close_starts),
        *(("daa.guidance", name, value) for name, value in asdict(guidance).items()),
        ("simulation", "step_ms", simulation.step_ms),
        ("simulation", "heartbeat_ms", simulation.heartbeat_ms),
        ("simulation", "limit_s", simulation.limit_ms / 1000),
        ("bridge", "uxas_route_planner", mission.live_planning),
        ("bridge", "lost_link_after_s", mission.bridge_times.lost_link_after_ms / 1000),
        ("bridge", "safe_state_after_s", mission.bridge_times.safe_state_after_ms / 1000),
    ):
        path = (*section.split("."), name)
        facts = mission_schema()
        for part in path:
            facts = facts["properties"][part]
        default = facts.get("default", False)
        said = _at(written, path) is not None
        given = value != default if written is None else said
        yield _may_be_given(f"{section}.{name}", 0, value, default, facts, given)
    guarded = sum(vehicle.protected for vehicle in mission.vehicles)
    given = _at(written, ("bridge", "instances")) is not None
    if written is None:
        given = len(mission.instances) != guarded
    yield Parameter(
        "bridge.instances", 0, len(mission.instances), "", guarded, 0, guarded,
        GIVEN if given else DEFAULT, "vehicles with an ICAROUS instance; left out: all protected ones",
    )  # fmt: skip
    for zone in _at(written, ("zones",)) or ():
        facts = mission_schema()["$defs"]["zone"]["properties"]["padding_m"]
        value, name = zone.get("padding_m"), f"zones[{zone['id']}].padding_m"
        yield _may_be_given(name, 0, value or 0.0, 0.0, facts, value is not None)


def _of_sensing(mission: Mission, written: Any) -> Iterator[Parameter]:
    if mission.sensing is None:
        return
    for row in rows_of(mission.sensing, mission_schema()["properties"][SECTION]):
        name = str(row.path[-1])
        said = written is None or _at(written, row.path) is not None
        made = _may_be_given(name, 0, row.value, row.facts.get("default"), row.facts, said)
        yield made._replace(name=row.name)


def _of_link_loss(mission: Mission, written: Any) -> Iterator[Parameter]:
    if mission.link_loss is None:
        return
    facts = mission_schema()["properties"]["link_loss"]["properties"]["after_s"]
    value = mission.link_loss.after_ms / 1000
    said = written is None or _at(written, ("link_loss", "after_s")) is not None
    yield _may_be_given("link_loss.after_s", 0, value, facts["default"], facts, said)


def _of_vehicle(vehicle: Vehicle, written: Any) -> Iterator[Parameter]:
    values = {
        "speed_m_s": vehicle.speed_m_s,
        "min_speed_m_s": vehicle.min_speed_m_s,
        "max_speed_m_s": vehicle.max_speed_m_s,
        "max_bank_deg": degrees(vehicle.max_bank_rad),
        "max_climb_m_s": vehicle.max_climb_m_s,
    }
    defaults = {"max_bank_deg": MAX_BANK_DEG, "max_climb_m_s": MAX_CLIMB_M_S}
    known = mission_schema()["$defs"]["vehicle"]["properties"]
    for name in VEHICLE:
        default = defaults.get(name)
        given = written is None or name in written
        if not given and default is None:
            facts = known[name]
            low, high = _range(facts)
            yield Parameter(
                name, vehicle.id, values[name], "m/s", None, low, high, DERIVED,
                f"not given: {CRUISE}",
            )  # fmt: skip
            continue
        yield _may_be_given(name, vehicle.id, values[name], default, known[name], given)


def _may_be_given(
    name: str, vehicle: int, value: Any, default: Any, facts: Any, given: bool
) -> Parameter:
    low, high = _range(facts)
    origin = GIVEN if given else DEFAULT
    how = facts.get("description", "").partition(" [")[0]
    return Parameter(name, vehicle, value, _unit(name), default, low, high, origin, how)


def _range(facts: Any) -> tuple[float | None, float | None]:
    low = facts.get("minimum", facts.get("exclusiveMinimum"))
    return low, facts.get("maximum", facts.get("exclusiveMaximum"))


def _unit(name: str) -> str:
    return next((unit for suffix, unit in UNITS.items() if name.endswith(suffix)), "")


def _derived(mission: Mission, vehicle: Vehicle) -> Iterator[Parameter]:
    d = derived(mission, vehicle)
    v, beat = d.volume, "2 heartbeat_ms"
    persist_s = traffic_monitor.PERSIST_MS / 1000
    rate = "turn rate"
    for name, value, unit, how in (
        ("kept DTHR", v.dthr_m, "m", "buffer x dthr_m"),
        ("kept ZTHR", v.zthr_m, "m", "buffer x zthr_m"),
        ("kept TTHR", v.tthr_s, "s", "buffer x tthr_s"),
        ("kept TCOA", v.tcoa_s, "s", "buffer x tcoa_s"),
        ("horizon", d.horizon_s, "s", "lookahead_s + kept TTHR"),
        ("search step", d.search_step_s, "s", f"lookahead_s / {STEPS}"),
        ("room", d.room_m, "m", "(buffer - 1) / 2 x dthr_m: how far off its predicted way it may be"),
        ("room in height", d.room_high_m, "m", "(buffer - 1) / 2 x zthr_m"),
        ("turn rate", degrees(d.turn_rate_rad_s), "deg/s", "g tan(max_bank) / speed"),
        ("turn radius", d.turn_radius_m, "m", f"speed / {rate}"),
        ("way back radius", d.way_back_radius_m, "m", f"{TURN_MARGIN:g} x turn radius"),
        ("near a waypoint", d.near_waypoint_m, "m", "3 x turn radius: nearer it makes for the next one"),
        ("hard limit", d.hard_limit_s, "s", f"90 deg / {rate} + {beat}: no loss nearer than this waits"),
        ("last time", d.last_time_s, "s",
         f"90 deg / {rate} + kept TTHR + {beat}: the one with the right of way waits until then"),
        ("least look-ahead", d.least_lookahead_s, "s", f"{persist_s:g} s + hard limit"),
        ("turn back", d.turn_back_s, "s", f"(180 deg + 1 rad) / {rate}: so far ahead zones are looked for"),
        ("turn drift", d.drift_m, "m",
         "speed x max(0.5 s, step_ms) / 2 x 90 deg: how far off the flown turn may be"),
        ("hold", d.hold_m, "m", f"way back radius + {TRACKING_S:g} s x speed: the disc that ends its way"),
        ("hold near zones", d.wide_hold_m, "m",
         f"2 x {WIDEST:g} x way back radius + {TRACKING_S:g} s x speed"),
        ("hold in height", d.hold_high_m, "m", f"{TRACKING_S:g} s x max_climb_m_s"),
        ("waypoint reached", d.reached_m, "m", f"{REACHED_S:g} s x speed"),
        ("end passed", d.passed_m, "m", f"{PASSED_S:g} s x speed"),
        ("floor", floor_of(mission), "m", f"terrain_m + {GROUND_MARGIN:g} x zthr_m: no descent goes lower"),
        ("leg given up", LONGEST_LOOKAHEADS * mission.daa.lookahead_s, "s",
         f"{LONGEST_LOOKAHEADS} x lookahead_s: so long ICAROUS flies it on one leg"),
    ):  # fmt: skip
        yield Parameter(name, vehicle.id, value, unit, None, None, None, DERIVED, how)


def _fixed() -> Iterator[Parameter]:
    for name, value, unit, how in (
        ("loss persists", traffic_monitor.PERSIST_MS / 1000, "s", "a predicted loss counts after this"),
        ("way back persists", return_to_path.PERSIST_MS / 1000, "s", "it is free for so long at a handback"),
        ("relapse", return_to_path.RELAPSE_MS / 1000, "s", "a takeover so soon after a handback is one"),
        ("link lost", LINK_LOST_MS / 1000, "s", "without a heartbeat of the bridge for so long"),
        ("on its path", ON_PATH_M, "m", "nearer than this to its path it is taken to fly along it"),
        ("turning", degrees(TURNING_RAD_S), "deg/s", "an intruder that turns faster flies no straight line"),
        ("heading step", float(STEP_DEG), "deg", "between the headings that are tried"),
        ("heading kept", degrees(KEEP_RAD), "deg", "a manoeuvre is kept unless one is nearer by more"),
        ("piece", PIECE_S, "s", "turns are predicted in pieces so long"),
        ("acceleration", MAX_ACCELERATION_M_S2, "m/s^2", "by which speeds are changed"),
        ("excuse: heading step", degrees(record.STEP_HDIR_RAD), "deg", f"{EXCUSE} headings"),
        ("excuse: speed step", record.STEP_HS_M_S, "m/s", f"{EXCUSE} speeds"),
        ("excuse: climb step", record.STEP_VS_M_S, "m/s", f"{EXCUSE} climb rates"),
        ("excuse: height step", record.STEP_ALT_M, "m", f"{EXCUSE} altitudes"),
        ("excuse: acceleration", record.ACCELERATION_M_S2, "m/s^2", f"{EXCUSE} speeds"),
        ("excuse: climb change", record.CLIMB_CHANGE_M_S2, "m/s^2", f"{EXCUSE} climb rates"),
        ("takeovers on a leg", MOST_TAKEOVERS, "", "at the next one the leg is given up"),
    ):  # fmt: skip
        yield Parameter(name, 0, value, unit, None, None, None, FIXED, how)
