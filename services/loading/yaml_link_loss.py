"""The sections `link_loss` and `landing_sites` of a mission file as `LinkLoss`; the schema sets the bounds."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cratous.core.authority.timeliness import lasted
from cratous.core.geofence.planar import keep_in_leg_ok
from cratous.services.loading.checks import Where, start_is_allowed
from cratous.services.loading.coordinates import Places
from cratous.services.loading.document import Document, item_name
from cratous.services.loading.landing_sites import landing_sites, site_problems
from cratous.services.loading.problems import refuse
from cratous.services.mission.ground import floor_of
from cratous.services.mission.landing import on_failure_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import LandingLoss, LinkLoss, Mission, Position, Simulation
from cratous.spec.mission.link_loss import WithoutLink
from cratous.spec.mission.link_loss import words as choice_words

FEWEST_BEATS = 2
"""Minimum length of a silence, in heartbeats, that indicates a lost link."""
Found = tuple[tuple[str, ...], str, str, str]


def yaml_link_loss(
    document: Document, places: Places, simulation: Simulation, instances: int
) -> LinkLoss | None:
    """The mission's lost-link procedure; BadMission if it is inconsistent.

    instances: number of vehicles that it applies to.
    """
    data, sites = document.data.get("link_loss"), landing_sites(document, places)
    refuse([*site_problems(document, sites)])
    if data is None:
        return None
    to = data.get("to")
    choice, name = WithoutLink(data["choice"]), "" if to is None else to["name"]
    after_ms = round(1000 * float(data.get("after_s", LinkLoss.after_ms / 1000)))
    place = None if to is None else places.position(to["position"])
    loss = LinkLoss(choice, after_ms, place, name)
    if choice is WithoutLink.LAND:
        loss = LandingLoss(choice, after_ms, place, data.get("site", name), sites)
    refuse([_problem(document, *one) for one in _found(loss, simulation, instances)])
    return loss


def words(loss: LinkLoss) -> str:
    """The section in words, for reports."""
    silence = f"without a word of UxAS for more than {loss.after_ms / 1000:g} s"
    what = choice_words(loss.choice, loss.name)
    return f"{silence}, each vehicle with ICAROUS acts by itself: {what}"


def place_problems(mission: Mission, where: Where) -> Iterator[BadInput]:
    """Faults of the place to return to: a zone present at the start, or the ground, prevents loitering there."""
    after = on_failure_of(mission)
    if mission.link_loss is not None and mission.link_loss.to is not None:
        yield from _place(mission, where, mission.link_loss.to, "link_loss")
    if after is not None and after.to is not None:
        yield from _place(mission, where, Position(*after.to), "on_failure")


def _place(mission: Mission, where: Where, to: Position, section: str) -> Iterator[BadInput]:
    item = f"{section}.to.position"

    def bad(what: str, expected: str, got: str) -> BadInput:
        return BadInput(what, where=where(item), item=item, expected=expected, got=got)

    floor_m = floor_of(mission)
    if not keep_in_leg_ok(1, False, to.alt_m, to.alt_m, floor_m, math.inf):
        above = f"above {floor_m:g} m MSL"
        yield bad("no manoeuvre goes so low", above, f"{to.alt_m:g} m MSL")
    for zone in mission.zones:
        if not start_is_allowed(to, zone):
            place = f"{to.north_m:g} m north, {to.east_m:g} m east, {to.alt_m:g} m MSL"
            yield bad("nothing returns there", f"a place that keeps zone {zone.id}", place)


def _found(loss: LinkLoss, simulation: Simulation, instances: int) -> Iterator[Found]:
    if not instances:
        yield (), "nobody would act by it", "a vehicle with an ICAROUS instance", "none"
    if loss.to is not None and loss.choice is not WithoutLink.RETURN:
        yield ("to",), "nothing returns there", "choice return", loss.choice.value
    if not lasted(0, loss.after_ms, FEWEST_BEATS * simulation.heartbeat_ms):
        least = FEWEST_BEATS * simulation.heartbeat_ms / 1000
        expected = f"at least {least:g} s, {FEWEST_BEATS} heartbeats"
        yield ("after_s",), "this silence says nothing", expected, f"{loss.after_ms / 1000:g} s"


def _problem(
    document: Document, key: tuple[str, ...], what: str, expected: str, got: str
) -> BadInput:
    full = ("link_loss", *key)
    return BadInput(
        what, where=document.where(full), item=item_name(full), expected=expected, got=got
    )
