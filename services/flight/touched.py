"""Whether what has become known in flight asks for another plan."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from cratous.core.legs import first_bad_leg
from cratous.core.visibility import name_of
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.dynamics import AirState
from cratous.spec.changes import TASK_ADDED, TASK_REMOVED, VEHICLE_JOINS, VEHICLE_LOST
from cratous.spec.mission import Change, Zone


def touched_by(
    due: Sequence[Change],
    zones: Sequence[Zone],
    chains: Mapping[int, Chain],
    ended: Collection[int],
    states: Mapping[int, AirState],
) -> str:
    """Why what has become known asks for another plan; empty if it does not.

    A new zone does if a leg that is still to be flown breaks it (kernels by `first_bad_leg`).
    ended: the tasks that are complete.
    """
    left = {c.vehicle.id: [i.task_id for i in c.items[max(c.k, 0) :]] for c in chains.values()}
    for change in due:
        if change.kind == VEHICLE_LOST and left.get(change.vehicle):
            return f"tasks {', '.join(map(str, left[change.vehicle]))} go to other vehicles"
        if change.kind == TASK_REMOVED and change.task not in ended:
            return f"task {change.task} is left out"
        if change.kind in (TASK_ADDED, VEHICLE_JOINS):
            return "what is left is shared out again"
    for vid, chain in sorted(chains.items()):
        ways = [(states[vid].position, *chain.track.rest(chain.s_m))]
        for item in chain.items[max(chain.k, 0) + 1 :]:
            ways += [item.transit, item.path]
        if chain.item is not None and chain.phase is not Phase.TASK:
            ways.append(chain.item.path)
        for way in ways:
            bad = first_bad_leg(way, zones) if way else None
            if bad is not None:
                return f"the way of vehicle {vid} breaks {name_of(bad[1])}"
    return ""
