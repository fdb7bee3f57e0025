"""For any number of regions, the fold gives the place in their intersection: its open part takes the open
parts of the regions, and its closed part the closed ones."""

from typing import Any

from cratous.core.geofence.regions import place_in_all
from cratous.proofs.claim import Claim
from cratous.proofs.methods.folds import places_are_combined
from cratous.spec.geofence import in_closed, in_open, intersection_step


def model_step(parts: Any, place: Any) -> Any:
    return intersection_step(parts, in_open(place), in_closed(place))


def claim(c: Claim) -> None:
    places_are_combined(c, place_in_all, model_step, start=True)
