"""Changes that a request or a service attribute makes to vehicle configurations before planning.

OverridePlanningConditions: speed and altitude, for one request. TurnRadiusOffset_m: wider turns,
for all.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from math import atan, degrees, isfinite, radians, tan
from typing import Any

from cratous.core.routing.dubins import turn_radius_m
from cratous.services.loading.uxas_cfg import Configuration, Sent
from cratous.spec.errors import BadInput

AIR = "AirVehicleConfiguration"
ITEM = "OverridePlanningConditions"


def kept(
    configurations: Mapping[int, Sent], pairs: Iterable[Any], tasks: Collection[int], where: str
) -> dict[int, Sent]:
    """Configurations by id with nominal speed and altitude set by SpeedAltPairs; 0 with AGL sets no
    altitude.

    tasks: of the request; BadInput for a pair for only some of them, an unknown vehicle, or a speed
    outside its range. where: the request.
    """
    wanted: dict[int, dict[int, Any]] = {}
    for pair in pairs:
        of = [pair.TaskID] if pair.TaskID else list(tasks)
        wanted.setdefault(pair.VehicleID, {}).update(dict.fromkeys(of, pair))
    made = dict(configurations)
    for number, by_task in wanted.items():
        if number not in made or type(made[number].body).__name__ != AIR:
            known = ", ".join(map(str, sorted(made))) or "none"
            raise BadInput(
                f"vehicle {number} has no {AIR}",
                where=where,
                item=ITEM,
                expected=f"one of {known}",
                got=str(number),
            )
        told = {(p.Speed, p.Altitude, p.AltitudeType) for p in by_task.values()}
        if len(told) != 1 or not set(tasks) <= by_task.keys():
            raise BadInput(
                f"vehicle {number} is to fly some tasks at another speed or altitude than others",
                where=where,
                item=ITEM,
                expected="one speed and altitude for all tasks of the request (TaskID 0)",
                got="for tasks " + ", ".join(map(str, by_task)),
            )
        made[number] = replace(made[number], body=_with(made[number].body, *told.pop(), where))
    return made


def _with(body: Any, speed: float, altitude: float, kind: Any, where: str) -> Any:
    least, most = body.MinimumSpeed, max(body.MaximumSpeed, body.NominalSpeed)
    if not (isfinite(speed) and speed > 0 and least <= speed <= most):
        raise BadInput(
            f"vehicle {body.ID} does not fly at this speed",
            where=where,
            item=f"{ITEM}.Speed",
            expected=f"{least:g} to {most:g} m/s",
            got=f"{speed:g}",
        )
    if not isfinite(altitude):
        raise BadInput(
            f"vehicle {body.ID} does not fly at this altitude",
            where=where,
            item=f"{ITEM}.Altitude",
            expected="a number of metres",
            got=f"{altitude:g}",
        )
    made = body.copy(NominalSpeed=speed)
    if altitude == 0 and kind.name == "AGL":
        return made
    return made.copy(NominalAltitude=altitude, NominalAltitudeType=kind)


def wider(cfg: Configuration, offset_m: float) -> Configuration:
    """A configuration with turn radii larger by offset_m [m] than at its nominal speed and bank."""
    messages = (
        replace(m, body=_wider(m.body, offset_m)) if type(m.body).__name__ == AIR else m
        for m in cfg.messages
    )
    return replace(cfg, messages=tuple(messages))


def _wider(body: Any, offset_m: float) -> Any:
    profile = body.NominalFlightProfile
    speed = body.NominalSpeed
    if profile is None or not 1 <= profile.MaxBankAngle <= 80 or not speed > 0:
        return body  # refused later for this error
    bank = radians(profile.MaxBankAngle)
    radius = turn_radius_m(speed, bank)
    bank = atan(tan(bank) * radius / (radius + offset_m))
    return body.copy(NominalFlightProfile=profile.copy(MaxBankAngle=degrees(bank)))
