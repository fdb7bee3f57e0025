"""The section `on_failure` of a mission file as `OnFailure`; the schema sets the bounds."""

from __future__ import annotations

from collections.abc import Iterator

from cratous.services.loading.coordinates import Places
from cratous.services.loading.document import Document, item_name
from cratous.services.loading.landing_sites import landing_sites
from cratous.services.loading.problems import refuse
from cratous.spec.errors import BadInput
from cratous.spec.mission.on_failure import AfterFailure, Failed, OnFailure

SECTION = "on_failure"


def yaml_on_failure(document: Document, places: Places, instances: int) -> OnFailure | None:
    """What is flown after a declared failure; None if the mission does not say. BadInput if it is inconsistent.

    instances: number of vehicles that it applies to.
    """
    data = document.data.get(SECTION)
    if data is None:
        return None
    choice, to = AfterFailure(data["choice"]), data.get("to")
    place = None if to is None else places.position(to["position"])
    of = tuple(Failed(one) for one in data.get("of", [one.value for one in Failed]))
    name = data.get("site", "") if to is None else to["name"]
    after = OnFailure(choice, of, place, name, landing_sites(document, places))
    refuse([*_problems(document, after, instances)])
    return after


def words(after: OnFailure) -> str:
    """The section in words, for reports."""
    of = ", ".join(one.value for one in after.of)
    return (
        f"after a declared failure ({of}) each vehicle with ICAROUS acts by itself: {after.words}"
    )


def _problems(document: Document, after: OnFailure, instances: int) -> Iterator[BadInput]:
    def bad(key: tuple[str, ...], what: str, expected: str, got: str) -> BadInput:
        item = item_name((SECTION, *key))
        where = document.where((SECTION, *key))
        return BadInput(what, where=where, item=item, expected=expected, got=got)

    if not instances:
        yield bad((), "nobody would act by it", "a vehicle with an ICAROUS instance", "none")
    if after.to is not None and after.choice is not AfterFailure.RETURN:
        yield bad(("to",), "nothing returns there", "choice return", after.choice.value)
