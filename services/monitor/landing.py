"""Which vehicles are on the ground, from the aircraft's positions: on a landing site or outside all
of them.

Well clear applies to aircraft in the air: a leg with both ends on the ground is not checked. A
landed vehicle has to stay there, to be at rest at the end, and to be alone on its site. A vehicle
that starts on the ground counts as on it until it has left. The kernel `on_ground` decides.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cratous.services.mission.landing import ground_m, is_down, site_under, sites_of
from cratous.services.mission.take_off import grounded
from cratous.services.monitor.samples import Sample
from cratous.spec.mission import Mission, Position


@dataclass
class Down:
    """A vehicle on the ground. site: owner in words, "" outside all sites; since_ms: time of
    landing; taken: fault text if the site was occupied; wrong: faults after landing that do not end
    the flight; stands: no motion in the last step; began: started there and has not left the
    ground.
    """

    site: str
    since_ms: int
    taken: str = ""
    wrong: str = ""
    stands: bool = False
    began: bool = False

    @property
    def good(self) -> bool:
        """True if it landed on a site, stayed there, and stands."""
        return bool(self.site) and not self.wrong and self.stands

    def words(self) -> str:
        """Where and since when, in words."""
        if self.began:
            return "it stands on the ground, where it started"
        where = f"at {self.site}" if self.site else "beside every landing site"
        return f"landed {where} at {self.since_ms / 1000:.2f} s"


class LandingWatch:
    """The vehicles that have landed, by number; none if the mission has no landing site. Vehicles
    that started on the ground are not included.
    """

    def __init__(self, mission: Mission) -> None:
        self._sites, self._terrain_m = sites_of(mission), mission.frame.terrain_m
        self.down: dict[int, Down] = {}
        self._not_yet = {one.id: one.ground_m for one in grounded(mission)}
        self._stood = set[int]()

    def step(
        self, before: dict[int, Sample], after: dict[int, Sample]
    ) -> tuple[dict[int, Sample], dict[int, Sample]]:
        """Process two successive instants; returns the samples of the aircraft in the air."""
        if not self._sites and not self._not_yet:
            return before, after
        still = {n for n in self._not_yet if n in before and n in after}
        for number in still:
            if not is_down(after[number].position.alt_m - self._not_yet[number]):
                del self._not_yet[number]
        still &= self._not_yet.keys()
        self._stood = {n for n in still if before[n].position == after[n].position}
        for number in before.keys() & after.keys() if self._sites else ():
            if after[number].ours and number not in self._not_yet:
                self._leg(number, before[number], after[number])
        still |= {
            n for n in self.down if n in before and n in after and self._stays(before[n], after[n])
        }
        flown = ({n: s for n, s in one.items() if n not in still} for one in (before, after))
        return next(flown), next(flown)

    def at_rest(self, seen: Callable[[int], bool]) -> dict[int, Down]:
        """Vehicles on the ground, including those that have not taken off yet and were observed throughout."""
        stood = {
            number: Down("its start", 0, stands=number in self._stood, began=True)
            for number in self._not_yet
            if seen(number)
        }
        return {**self.down, **stood}

    def _stays(self, before: Sample, after: Sample) -> bool:
        return self._is_down(before.position) and self._is_down(after.position)

    def _leg(self, number: int, before: Sample, after: Sample) -> None:
        down, place = self.down.get(number), after.position
        if not self._is_down(place):
            if down is not None and not down.wrong:
                down.wrong = f"it was in the air again at {after.time_ms / 1000:.2f} s"
            return
        if down is None:
            site = site_under(place, self._sites)
            name = "" if site is None else site.name
            there = [n for n, other in self.down.items() if name and other.site == name]
            taken = f"vehicle {there[0]} was there before it" if there else ""
            self.down[number] = Down(name, after.time_ms, taken)
            return
        here = site_under(place, self._sites)
        if (here.name if here else "") != down.site and not down.wrong:
            down.wrong = f"it rolled beyond it by {after.time_ms / 1000:.2f} s"
        down.stands = before.position == place

    def _is_down(self, place: Position) -> bool:
        return is_down(place.alt_m - ground_m(place, self._sites, self._terrain_m))
