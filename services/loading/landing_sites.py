"""The section `landing_sites` of a mission file, and checks beyond the schema's bounds."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations

from cratous.core.avoidance.landing import on_ground, roll_fits
from cratous.core.geofence.planar import keep_in_leg_ok
from cratous.core.permit.remainder import zones_permit
from cratous.services.loading.checks import Finding, as_errors
from cratous.services.loading.coordinates import Places
from cratous.services.loading.document import Document
from cratous.services.mission.landing import BRAKING_M_S2, sites_of, touches_off_m
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, Position
from cratous.spec.mission.link_loss import LandingSite
from cratous.spec.mission.on_failure import AfterFailure

SECTION = "landing_sites"
LANDING_SECTIONS = ("link_loss", "on_failure")
LANDS = (AfterFailure.LAND.value, AfterFailure.DITCH.value)


def landing_sites(document: Document, places: Places) -> tuple[LandingSite, ...]:
    """The sites, in file order. The altitude of a site defaults to that of the terrain."""
    found = []
    for one in document.data.get(SECTION, []):
        place = places.position(one["position"])
        radius_m, ditch = float(one["radius_m"]), bool(one.get("ditch", False))
        found.append(LandingSite(one["name"], *place, radius_m, ditch))
    return tuple(found)


def site_problems(document: Document, sites: tuple[LandingSite, ...]) -> Iterator[BadInput]:
    """Problems with landing sites: unused ones, duplicate names, and landings that name an unknown site."""
    asked = {one: document.data[one] for one in LANDING_SECTIONS if one in document.data}
    names = [site.name for site in sites]
    if sites and not any(loss["choice"] in LANDS for loss in asked.values()):
        yield BadInput(
            "no vehicle lands at these sites",
            where=document.where((SECTION,)),
            item=SECTION,
            expected="link_loss or on_failure with choice land beside them",
            got=", ".join(loss["choice"] for loss in asked.values()) or "none",
        )
    for k, name in enumerate(names):
        if name in names[:k]:
            yield BadInput(
                "two landing sites have the same name",
                where=document.where((SECTION, k, "name")),
                item=f"{SECTION}[{k}].name",
                expected="names that differ",
                got=name,
            )
    for section in asked:
        yield from _named(document, section, sites)


def _named(document: Document, section: str, sites: tuple[LandingSite, ...]) -> Iterator[BadInput]:
    """Problems with the site that a section names."""
    loss = document.data[section]
    ditches, lands = loss["choice"] == AfterFailure.DITCH.value, loss["choice"] in LANDS
    asked = [site.name for site in sites if site.ditch or not ditches]
    site = loss.get("site")
    if site is not None and not lands:
        yield BadInput(
            "no vehicle lands at this site",
            where=document.where((section, "site")),
            item=f"{section}.site",
            expected="choice land",
            got=loss["choice"],
        )
    if lands and (not asked or site not in (None, *asked)):
        key = "site" if site else "choice"
        what = "landing site" + (" to ditch at" if ditches else "")
        yield BadInput(
            f"there is no such {what}" if site else f"there is no {what}",
            where=document.where((section, key)),
            item=f"{section}.{key}",
            expected=f"one of landing_sites: {', '.join(asked) or 'none'}",
            got=site or "none",
        )


@as_errors
def ground_problems(mission: Mission) -> Iterator[Finding]:
    """Sites that zones forbid at the start, that are too small for a vehicle's landing roll, or
    that overlap; and ground as high as the mission's flight altitudes.
    """
    yield from _heights(mission)
    yield from _overlaps(mission)
    guarded = [mission.vehicle(number) for number in mission.instances]
    for k, site in enumerate(sites_of(mission)):
        place = Position(site.north_m, site.east_m, site.ground_m)
        for zone in mission.zones:
            if not zones_permit(place, (zone,), site.radius_m):
                item = f"{SECTION}[{k}].position"
                yield Finding(
                    item,
                    f"nobody may land at {site.name}",
                    f"a disc on the ground that keeps zone {zone.id}",
                    f"{site.radius_m:g} m around {site.north_m:g} m north, {site.east_m:g} m east,"
                    f" at {site.ground_m:g} m MSL",
                )
        for vehicle in guarded:
            speed = vehicle.min_speed_m_s
            off_m = touches_off_m(mission, vehicle)
            if not roll_fits(site.radius_m, speed, BRAKING_M_S2, off_m):
                item, least_m = f"{SECTION}[{k}].radius_m", speed * speed / (4 * BRAKING_M_S2)
                yield Finding(
                    item,
                    f"vehicle {vehicle.id} does not come to a stand on {site.name}",
                    f"at least {least_m + off_m:.4g} m, for a landing at {speed:g} m/s",
                    f"{site.radius_m:g} m",
                )


def _heights(mission: Mission) -> Iterator[Finding]:
    """Ground of a site, or terrain outside all sites, at or above which a vehicle has to start or fly its tasks."""
    sites = sites_of(mission)
    grounds = [
        (f"{SECTION}[{k}].position", f"the ground of {site.name}", site.ground_m)
        for k, site in enumerate(sites)
    ]
    if sites:
        grounds.append(("frame.terrain_m", "the terrain", mission.frame.terrain_m))
    for item, ground, ground_m in grounds:
        for vehicle in mission.vehicles:
            flown_m = min(vehicle.position.alt_m, vehicle.cruise_alt_m)
            # strictly above, as with the floor of a keep-in zone
            if not keep_in_leg_ok(1, False, flown_m, flown_m, ground_m, math.inf):
                yield Finding(
                    item,
                    f"{ground} is as high as vehicle {vehicle.id} flies",
                    f"below {flown_m:g} m MSL, at which it starts or flies its tasks",
                    f"{ground_m:g} m MSL",
                )
                break


def _overlaps(mission: Mission) -> Iterator[Finding]:
    """Pairs of sites with overlapping discs: each has room for one vehicle."""
    for (_, one), (k, two) in combinations(enumerate(sites_of(mission)), 2):
        north_m, east_m = two.north_m - one.north_m, two.east_m - one.east_m
        both_m = one.radius_m + two.radius_m
        if on_ground(north_m, east_m, both_m, 0.0, 0.0):
            item = f"{SECTION}[{k}].position"
            yield Finding(
                item,
                f"landing sites {one.name} and {two.name} overlap",
                f"middles more than {both_m:g} m apart",
                f"{math.hypot(north_m, east_m):g} m",
            )
