"""`cratous campaign --find`: search for a failing run, and keep it as a simplified mission file."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import click

from cratous.services.cli.progress import passing
from cratous.services.cli.show import say

NAME, CASE = "search.json", "found"
FORMAT = "cratous-search/1"


def searched(
    campaign: Any, place: Path, how: dict[str, Any], requirement: str, budget: int,
    tell: Callable[[str], None],
) -> dict[str, Any]:  # fmt: skip
    """Search, write search.json and the failing mission into a folder, and return what was found."""
    from cratous.core import ledger
    from cratous.core.files.whole_file import write_atomically
    from cratous.services.campaign.campaign import Conduct, Course
    from cratous.services.campaign.engine import engine
    from cratous.services.campaign.identity import version_digest
    from cratous.services.campaign.outcomes import code_of
    from cratous.services.campaign.runs import Run
    from cratous.services.campaign.search import Search
    from cratous.services.campaign.store import Store
    from cratous.services.cli.encounter_flight import function_of

    ledger.require(allow_unproved=how["allow_unproved"])
    version = version_digest()
    search = Search(campaign, requirement, version, how["allow_unproved"])
    with Store(place) as store, engine(how["workers"], how["scheduler"]) as made:
        conduct = Conduct(
            campaign, store, function_of(campaign.kind), version, how["allow_unproved"]
        )
        course = Course(budget)

        def fly(runs: Iterable[Run]) -> list[Any]:
            some = list(runs)
            conduct.fly(made, course, passing(tell), some)
            return list(conduct.rows(some))

        found = search.run(fly, budget)
    failing = found.failing
    data: dict[str, Any] = {
        "format": FORMAT, "requirement": requirement, "version": version, "budget": budget,
        "points": found.points, "runs": len(found.points),
        "found": None if failing is None else failing.run.name,
        "why": "" if failing is None else failing.why,
        "case": None if found.small is None else f"{CASE}-{requirement}.yaml",
        "exit_code": 1 if failing is not None else code_of({p["outcome"] for p in found.points}),
    }  # fmt: skip
    if found.small is not None and failing is not None:
        text = _case(found.small, requirement, failing.run.decides)
        write_atomically(place / data["case"], text, "the mission that was found")
    text = json.dumps(data, indent=1, sort_keys=True, ensure_ascii=False) + "\n"
    write_atomically(place / NAME, text, "the search")
    return data


def _case(mission: dict[str, Any], requirement: str, decides: dict[str, Any]) -> str:
    """The mission file with its expected result; none for an encounter, as it is flown whole there."""
    import yaml

    from cratous.services.campaign.definition import ALL, ENCOUNTERS
    from cratous.services.cli.campaign_flight import command

    text = yaml.safe_dump(mission, sort_keys=False, allow_unicode=True)
    if decides["kind"] == ENCOUNTERS:
        how = "flown" if decides["daa"] else "flown without avoidance"
        return f"# {requirement} is violated in this encounter ({how}), found by a search and made small\n{text}"
    if requirement in ALL:  # a mission file has expectations for guarantees only
        without = {"exit_code": 1, "violated": [requirement]}
        expect = {"exit_code": 1} if decides["daa"] else {"without_daa": without}
        text = yaml.safe_dump({**mission, "expect": expect}, sort_keys=False, allow_unicode=True)
    return f"# {requirement} is violated, found by a search and made small:  {command(decides)}\n{text}"


def show_found(data: dict[str, Any], place: Path, as_json: bool) -> None:
    """Print what was found, as text or as JSON."""
    if as_json:
        click.echo(json.dumps(data, indent=1, sort_keys=True))
        return
    told = [point["margin"] for point in data["points"] if point["margin"] is not None]
    least = f"least margin {min(told):.4g}" if told else "nothing was measured"
    if data["found"] is None:
        say(f"{data['requirement']}: not found to fail in {data['runs']} runs, {least}")
        counts = Counter(point["outcome"] for point in data["points"])
        say(f"of these: {', '.join(f'{count} {name}' for name, count in sorted(counts.items()))}")
        say("A search that finds nothing shows nothing: other runs may fail.")
    else:
        say(
            f"{data['requirement']} fails in {data['found']}, after {data['runs']} runs: {data['why']}"
        )
        say(f"made small: {place / data['case']}")
    say(f"all points: {place / NAME}; exit code {data['exit_code']}")
