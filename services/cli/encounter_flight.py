"""Flies and judges one run of an encounter campaign in a persistent process."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

from cratous.services.cli import campaign_flight
from cratous.services.cli.campaign_flight import result_of_file, standing

FUNCTION = f"{__name__}:fly_run"


def function_of(kind: str) -> str:
    """The function that flies a run of a campaign of this kind, as `module:name`."""
    from cratous.services.campaign.definition import ENCOUNTERS

    return FUNCTION if kind == ENCOUNTERS else campaign_flight.FUNCTION


def fly_run(task: dict[str, Any]) -> dict[str, Any]:
    """The result of a run, as plain data determined by `task` alone.

    task: `decides` of a run: mission, seed, daa, allow_unproved.
    """
    return result_of_file(task, _flown)


def _flown(file: Path, task: dict[str, Any]) -> dict[str, Any]:
    from cratous.services.campaign.encounters import Judged, result_of, states_of
    from cratous.services.cli.judge import encounter_rows
    from cratous.services.flight.encounter import fly_encounter
    from cratous.services.loading import load

    mission = load(file, task["seed"])
    proved = not standing(task["allow_unproved"]).problems
    flown = fly_encounter(mission, daa=task["daa"])
    states = states_of(flown)
    found = encounter_rows(file, states, flown.reached)
    rows = [Judged(row.guarantee, row.item, row.verdict, row.note) for row in found]
    name = hashlib.sha256(task["mission"].encode()).hexdigest()
    return result_of(mission, flown, states, rows, proved, name)
