"""The search: it needs fewer runs than sampling, what it finds fails and is small, and it is the same again."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import atan2, degrees, hypot
from pathlib import Path
from statistics import median
from typing import Any

import campaign_child
import pytest
from campaign_child import written

from cratous.services.campaign.definition import Campaign, load_campaign
from cratous.services.campaign.outcomes import Row, row_of
from cratous.services.campaign.runs import Run
from cratous.services.campaign.search import Search
from cratous.services.cli.campaign_find import show_found
from cratous.spec.errors import BadInput

RARE = "seeds: [1, 1]\nvary: [{item: 'vehicles[0].speed_m_s', range: [1, %s]}]\n"


class Flights:
    """Flights that are counted."""

    def __init__(self, result: Any = campaign_child.fly) -> None:
        self.count, self._result = 0, result

    def __call__(self, runs: Iterable[Run]) -> list[Row]:
        some = list(runs)
        self.count += len(some)
        return [row_of(run, self._result(run.decides), ("G2",)) for run in some]


def rare(tmp_path: Path, top: float) -> Campaign:
    """Speeds above 30 fail."""
    return load_campaign(written(tmp_path, {"plain": ""}, RARE % top), None, ())


def test_it_finds_what_sampling_seldom_does(tmp_path: Path) -> None:
    campaign = rare(tmp_path, 30.05)  # one draw in 580 fails
    found = Search(campaign, "G2", "v", False).run(Flights(), 100)
    assert found.failing is not None
    assert len(found.points) <= 80
    again = Search(campaign, "G2", "v", False).run(Flights(), 100)
    assert (again.points, again.small) == (found.points, found.small)


def to_the_right(task: dict[str, Any]) -> dict[str, Any]:
    """Fails where an intruder goes to the right, at about 60 degrees and 34 m/s, and a zone lies to the right,
    from 300 m on: one draw in 1,120."""
    import yaml

    mission = yaml.safe_load(task["mission"])
    traffic, zones = mission.get("traffic"), mission.get("zones")
    if not traffic or not zones:
        return campaign_child.flown({"G2": 2.0})
    north, east = traffic[0]["velocity"]["north_m_s"], traffic[0]["velocity"]["east_m_s"]
    off = abs(degrees(atan2(east, north)) - 60) / 60 + abs(hypot(north, east) - 34) / 20
    off += abs(zones[0]["vertices"][0][1] - 300) / 1000
    return campaign_child.flown({"G2": off - 0.15})


def test_sides_are_searched_as_numbers_are() -> None:
    counts, generator = [], {"kind": "converging", "zones_beside": 1}
    for start in range(10):
        seeds = range(1 + 1000 * start, 2 + 1000 * start)
        campaign = Campaign("made", generator=generator, seeds=seeds)
        found = Search(campaign, "G2", "v", False).run(Flights(to_the_right), 200)
        counts.append(len(found.points))
        assert {p["values"]["side angle_deg[1]"] for p in found.points} == {-1, 1}
        assert found.small is not None
        assert found.failing is not None
    # sampling needs 776 in the median, as 1 of 1,120 draws fails
    assert median(counts) <= 776 / 8, counts


def test_the_first_batch_is_in_every_part_of_each_range() -> None:
    for first in (1, 5001):
        campaign = Campaign("made", generator={"kind": "converging"}, seeds=range(first, first + 1))
        points = Search(campaign, "G2", "v", False).run(Flights(), 10).points
        drawn = [p["values"] for p in points]
        tenths = {
            name: [int((one[name] - low) / (high - low) * 10 - 1e-9) for one in drawn]
            for name, (low, high) in (("time_s", (70, 110)), ("miss_m[1]", (-50, 50)))
        }
        assert all(sorted(parts) == list(range(10)) for parts in tenths.values()), tenths
        assert tenths["time_s"] != tenths["miss_m[1]"], "each range in an order of its own"


def test_values_of_a_list_are_searched_too(tmp_path: Path) -> None:
    more = "vary: [{item: 'vehicles[0].max_climb_m_s', values: [1, 2, 3, 4, 5, 6, 7, 8, 9]},\n"
    more += "       {item: 'vehicles[0].speed_m_s', range: [1, 25]}]\nseeds: [1, 1]\n"
    campaign = load_campaign(written(tmp_path, {"plain": ""}, more), None, ())
    found = Search(campaign, "G2", "v", False).run(Flights(best_at_seven), 60)
    told = [p["values"]["vehicles[0].max_climb_m_s"] for p in found.points]
    assert found.failing is None
    near = [sum(value in (6, 7, 8) for value in part) for part in (told[:10], told[-10:])]
    assert near[0] < 7 <= near[1]


def best_at_seven(task: dict[str, Any]) -> dict[str, Any]:
    import yaml

    climb = yaml.safe_load(task["mission"])["vehicles"][0]["max_climb_m_s"]
    return campaign_child.flown({"G2": 1.0 + abs(climb - 7)})


def test_what_fails_is_made_small_and_fails(tmp_path: Path) -> None:
    generator = {"kind": "converging", "intruders": 3, "zones_beside": 2}
    campaign = Campaign("made", generator=generator, seeds=range(1, 2))

    def result(task: dict[str, Any]) -> dict[str, Any]:
        import yaml

        data = yaml.safe_load(task["mission"])
        guilty = [t for t in data.get("traffic", []) if t["id"] == 102]
        return campaign_child.flown({"G2": -1.0 if guilty else 1.0})

    fly = Flights(result)
    found = Search(campaign, "G2", "v", False).run(fly, 200)
    assert found.small is not None
    assert [t["id"] for t in found.small["traffic"]] == [102]
    assert "zones" not in found.small
    assert found.small["vehicles"][0]["speed_m_s"] in range(18, 29), "a whole number"
    assert fly.count <= 20 + 100


def test_another_first_seed_is_another_search(tmp_path: Path) -> None:
    first = rare(tmp_path, 25)
    other = replace(first, seeds=range(1001, 1002))
    one, two = (Search(c, "G2", "v", False).run(Flights(), 45).points for c in (first, other))
    assert len(one) == len(two) == 45, "in whole batches, and a part of one"
    drawn = [{str(p["values"]) for p in points[:10]} for points in (one, two)]
    assert drawn[0].isdisjoint(drawn[1])
    assert [p["run"] for p in two] == [f"plain-as-written-seed{n}" for n in range(1001, 1046)]


def test_nothing_found_is_no_find(tmp_path: Path) -> None:
    found = Search(rare(tmp_path, 25), "G2", "v", False).run(Flights(), 30)
    assert (found.failing, found.small, len(found.points)) == (None, None, 30)


def test_disagreement_is_a_find_and_what_was_not_flown_is_none(tmp_path: Path) -> None:
    def disputed(task: dict[str, Any]) -> dict[str, Any]:
        result = campaign_child.flown({"G2": 5.0})
        result["judge"]["disagreements"] = [
            {"guarantee": "G2", "item": "", "judge": "violated", "monitor": "holds", "note": ""}
        ]
        return result

    assert Search(rare(tmp_path, 25), "G2", "v", False).run(Flights(disputed), 20).failing
    lost = Flights(lambda _task: {"kind": "no plan", "why": ["x"]})
    found = Search(rare(tmp_path, 25), "G2", "v", False).run(lost, 40)
    assert found.failing is None
    assert {p["margin"] for p in found.points} == {None}


def test_a_search_is_in_one_space(tmp_path: Path) -> None:
    options = "options: [{name: a}, {name: b, daa: false}]\n"
    campaign = load_campaign(written(tmp_path, {"plain": ""}, RARE % 9 + options), None, ())
    with pytest.raises(BadInput, match="one space"):
        Search(campaign, "G2", "v", False)
    with pytest.raises(BadInput, match="nothing to search"):
        Search(load_campaign(written(tmp_path, {"plain": ""}, ""), None, ()), "G2", "v", False)


def test_where_nothing_is_found_it_says_what_became_of_the_runs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The requirement was looked at alone: the exit code speaks of all that the runs came to."""
    points = [{"outcome": name, "margin": 5.0} for name in ("holds", "misfit", "holds")]
    data = {"requirement": "G2", "points": points, "runs": 3, "found": None, "exit_code": 1}
    show_found(data, tmp_path, False)
    said = capsys.readouterr().out
    assert "G2: not found to fail in 3 runs, least margin 5\nof these: 2 holds, 1 misfit\n" in said
    assert "exit code 1" in said
