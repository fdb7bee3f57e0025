"""Why zones exclude every path between two places, where that can be told without a search."""

from __future__ import annotations

from collections.abc import Sequence

from cratous.core.geofence.separation import separating
from cratous.core.permit.remainder import zones_permit
from cratous.core.routing.visibility import name_of
from cratous.spec.mission import Position, Zone


def excluded(
    start: Position, end: Position, zones: Sequence[Zone], layers_m: Sequence[float] = ()
) -> str:
    """Why no path leads from start to end between the lowest and the highest of their altitudes and the layers [m];
    "" where that is not known. ValueError if a zone has padding.
    """
    for name, place in (("start", start), ("end", end)):
        for zone in zones:
            if not zones_permit(place, (zone,), 0.0):
                return f"its {name} breaks {name_of(zone)}"
    levels = (start.alt_m, end.alt_m, *layers_m)
    ids = separating(start, end, zones, min(levels), max(levels))
    if not ids:
        return ""
    named = ", ".join(str(one) for one in ids)
    between = f"from {min(levels):g} to {max(levels):g} m"
    return f"no path exists {between}: zones {named} together separate start and end"
