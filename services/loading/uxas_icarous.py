"""What the IcarousCommunicationService of a UxAS configuration says of its mission."""

from __future__ import annotations

from typing import NamedTuple

from cratous.services.loading.checks import too_many_instances
from cratous.services.loading.coordinates import Places
from cratous.services.loading.lost_link_attributes import ATTRIBUTES, lost_link_attributes
from cratous.services.loading.problems import refuse
from cratous.services.loading.uxas_cfg import Configuration
from cratous.services.loading.uxas_settings import Entry, values_of
from cratous.services.loading.yaml_daa import DEFAULT_WELL_CLEAR
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import integer_of
from cratous.spec.mission import Daa, LinkLoss, LinkLossDaa, Position, Vehicle
from cratous.spec.mission.bridge_times import USUAL, BridgeTimes

SERVICE = "IcarousCommunicationService"
PLACE = "the place of LostLinkTo"


class WithoutIcarous(NamedTuple):
    """daa: of the mission, with what is flown without the link; times: of the bridge; where: the service's place."""

    daa: Daa = Daa(DEFAULT_WELL_CLEAR)
    times: BridgeTimes = USUAL
    where: str = ""


def without_icarous(
    cfg: Configuration, places: Places, instances: tuple[int, ...], notes: list[str]
) -> WithoutIcarous:
    """What is flown while an instance is not heard, by the service's attributes. BadInput for wrong values."""
    found = cfg.service(SERVICE)
    if found is None:
        return WithoutIcarous()
    attributes, where = found
    given = {name: text for name, text in attributes.items() if name in ATTRIBUTES}
    problems: list[BadInput] = []
    values = values_of(ATTRIBUTES, given, where, SERVICE, problems)
    refuse(problems)
    entry = Entry("Service", SERVICE, attributes, (), where)
    choice, after_ms, to = lost_link_attributes(entry, values)
    if choice is None:
        return WithoutIcarous(times=BridgeTimes(lost_link_after_ms=after_ms), where=where)
    if not instances:
        notes.append("LostLink is not used: no vehicle has an ICAROUS instance")
        return WithoutIcarous(where=where)
    place = None if to is None else Position(*places.local(to.lat_deg, to.long_deg), to.alt_m)
    loss = LinkLoss(choice, after_ms, place, "" if place is None else PLACE)
    return WithoutIcarous(LinkLossDaa(DEFAULT_WELL_CLEAR, link_loss=loss), where=where)


def instances_of(
    cfg: Configuration, vehicles: tuple[Vehicle, ...]
) -> tuple[tuple[int, ...], list[str]]:
    """The vehicles with an instance, and notes. BadInput for a number that is none, or of more than there are."""
    ids = tuple(vehicle.id for vehicle in vehicles)
    found = cfg.service(SERVICE)
    if found is None:
        return ids, [f"no {SERVICE}: each vehicle is protected by an instance all the same"]
    attributes, where = found
    text = attributes.get("NumberOfUAVs", "")
    item = f"{SERVICE}.NumberOfUAVs"
    number = integer_of(text, 0, 2**31)
    if number is None:
        raise BadInput("not a number", where=where, item=item, expected="a whole number", got=text)
    if number > len(ids):
        raise too_many_instances(number, len(ids), where, item)
    return tuple(sorted(ids)[:number]), []
