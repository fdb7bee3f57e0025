"""What a plan costs: distance and energy, against trying everything; what is said of it."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations, product
from pathlib import Path

import pytest
import yaml
from planning_tools import FOUR, TWO, mission

from cratous.bridge import lmcp
from cratous.core.assignment.problem import START
from cratous.services.bus import Bus
from cratous.services.cli.plan import why_lines
from cratous.services.cli.plan_lines import plan_line
from cratous.services.loading import load
from cratous.services.pipeline.plan import cost_of, make_plan
from cratous.services.planning import stages
from cratous.services.planning.inputs import Inputs
from cratous.services.planning.vehicle_alternatives import why
from cratous.spec.errors import BadInput, NoPlan
from cratous.spec.mission import Mission
from cratous.spec.mission.plan import cost_text

POPUP = Path(__file__).resolve().parents[2] / "examples" / "popup" / "mission.yaml"
THIRSTY = (replace(TWO[0], power_w=900.0), replace(TWO[1], power_w=150.0))


def least(of: Mission, rate: dict[int, float]) -> int:
    """By trying every option of every task in every order on every vehicle: time flown times a rate."""
    inputs = Inputs(of, stages.start_poses(of))
    by_task = [
        [k for k, option in enumerate(inputs.options) if option.task_id == task.id]
        for task in of.tasks
    ]
    best = None
    for chosen in product(*by_task):
        for who in product(range(len(of.vehicles)), repeat=len(chosen)):
            total = 0
            for v, vehicle in enumerate(of.vehicles):
                mine = [k for k, owner in zip(chosen, who, strict=True) if owner == v]
                costs = []
                for order in permutations(mine):
                    at, cost = START, 0
                    for k in order:
                        way = inputs.routes.travel_ms(v, at, k)
                        assert way is not None
                        cost += round((way + inputs.options[k].duration_ms) * rate[vehicle.id])
                        at = k
                    costs.append(cost)
                total += min(costs)
            best = total if best is None else min(best, total)
    assert best is not None
    return best


@pytest.mark.parametrize(
    ("cost", "rate"), [("DISTANCE", {1: 22.0, 2: 22.0}), ("ENERGY", {1: 900.0, 2: 150.0})]
)
def test_the_least_of_all_plans_is_found(cost: str, rate: dict[int, float]) -> None:
    of = mission((FOUR[0], FOUR[2]), THIRSTY, cost=cost)
    plan = make_plan(of)
    assert plan.status == "optimal"
    assert cost_of(plan, of) == plan.bound == least(of, rate)


def test_energy_is_left_to_the_frugal_vehicle() -> None:
    of = mission(FOUR[:3], THIRSTY, cost="ENERGY")
    bus, told = Bus(lmcp.full_names), []
    bus.tap(lambda e: told.append(e.body) if e.topic.endswith(".ServiceStatus") else None)
    plan = make_plan(of, bus)
    assert {item.vehicle_id for item in plan.items} == {2}
    spent = cost_of(plan, of)
    quickest = make_plan(replace(of, cost="MINMAX"))
    assert spent < cost_of(replace(quickest, cost="ENERGY"), of)
    facts = {pair.Key: pair.Value for body in told for pair in body.Info}
    assert facts["cost_mj"] == str(spent)
    assert f"; {plan.makespan_ms / 1000:.1f} s, {spent / 1e6:.1f} kJ, " in plan_line(of, plan, [])
    instead = why(of, plan, 1, {})
    assert [(one.vehicle, one.cost is not None and one.cost > spent) for one in instead] == [
        (1, True), (2, False),
    ]  # fmt: skip
    assert why_lines(of, plan, 1, instead)[0].endswith(f"the plan costs {spent / 1e6:.1f} kJ")


def test_costs_in_words() -> None:
    said = [cost_text(kind, 12_345_678) for kind in ("MINMAX", "CUMULATIVE", "DISTANCE", "ENERGY")]
    assert said == ["12345.7 s", "12345.7 s", "12.346 km", "12.3 kJ"]


def test_energy_needs_the_power_of_every_vehicle(tmp_path: Path) -> None:
    data = yaml.safe_load(POPUP.read_text(encoding="utf-8"))
    data["cost"] = "ENERGY"
    data["vehicles"][0]["power_w"] = 800
    file = tmp_path / "mission.yaml"
    file.write_text(yaml.safe_dump(data), encoding="utf-8")
    with pytest.raises(BadInput, match="what vehicle 2 draws in flight") as error:
        load(file)
    assert error.value.item == "vehicles[1].power_w"
    for vehicle in data["vehicles"]:
        vehicle["power_w"] = 800
    file.write_text(yaml.safe_dump(data), encoding="utf-8")
    assert load(file).vehicles[1].power_w == 800.0
    with pytest.raises((BadInput, NoPlan), match="draws in flight"):
        make_plan(mission(FOUR[:1], cost="ENERGY"))
