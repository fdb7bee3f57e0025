"""The assignment of missions: its certificate, its limits, and the reasons why there is none."""

from __future__ import annotations

import copy
import json
from pathlib import Path

import pytest

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.cli import main
from cratous.services.loading import load
from cratous.services.loading.assignment_attributes import NODES_PER_MS
from cratous.services.monitor.plan_check import check_plan
from cratous.services.pipeline.plan import certificate_of, make_plan
from cratous.services.planning.assign_certificate import verify
from cratous.spec.errors import NoPlan
from cratous.spec.mission.guarantees import Outcome

CROSSING = Path(__file__).parents[2] / "examples" / "crossing" / "mission.yaml"
BOTH = 'relations: "|(p1 p2)"                 # both, in any order'


@pytest.fixture
def crossing(tmp_path: Path):
    """A mission file like the crossing with other relations, and more text at its end."""

    def write(relations: str, more: str = "") -> Path:
        text = CROSSING.read_text(encoding="utf-8")
        assert BOTH in text
        text = text.replace(BOTH, f'relations: "{relations}"').replace("eligible: [2]", "")
        file = tmp_path / "mission.yaml"
        file.write_text(text.replace("eligible: [1]", "") + more, encoding="utf-8")
        return file

    return write


@pytest.mark.parametrize(
    "relations",
    ["|(p1 p2)", "+(.(p1 p2) .(p2 p1))-[0-900000]", "~(p2 p1)_[200000-800000]", ".(p2 p1)-[60000-400000]"],
)  # fmt: skip
def test_the_plan_is_optimal_by_its_certificate(relations: str, crossing) -> None:
    mission = load(crossing(relations))
    bus = Bus(lmcp.full_names)
    plan = make_plan(mission, bus)
    body = certificate_of(bus)
    assert body is not None
    assert (plan.status, plan.certificate) == ("optimal", body["sha256"])
    assert plan.bound == plan.makespan_ms == verify(body).cost
    assert all(check.outcome is Outcome.HOLDS for check in check_plan(mission, plan))
    for item in plan.items:
        waits = next(c for c in body["problem"]["choices"] if c["task_id"] == item.task_id)
        assert item.wait_ms == 0 or item.wait_ms >= waits["lap_ms"] > 0


def test_a_cheaper_claim_is_refused(crossing) -> None:
    bus = Bus(lmcp.full_names)
    make_plan(load(crossing(".(p2 p1)-[60000-400000]")), bus)
    body = copy.deepcopy(certificate_of(bus))
    assert body is not None
    assert verify(body).wrong == ""
    body["steps"][1]["start_ms"] -= 1
    assert "digest" in verify(body).wrong


def test_the_first_leaf_claims_no_more_than_it_knows(crossing) -> None:
    mission = load(crossing("|(p1 p2)", "\nsearch: {nodes: 0}\n"))
    assert mission.node_limit == 0
    plan = make_plan(mission)
    assert plan.bound <= plan.makespan_ms
    assert plan.exhausted == (plan.status == "optimal") == (plan.bound == plan.makespan_ms)


def test_limits_of_the_search_are_read(crossing) -> None:
    both = load(crossing("|(p1 p2)", "\nsearch: {nodes: 5000000, deadline_ms: 200, gap: 0.05}\n"))
    assert (both.node_limit, both.gap) == (200 * NODES_PER_MS, 0.05)
    assert load(crossing("|(p1 p2)")).node_limit is None
    assert main(["plan", str(crossing("|(p1 p2)", "\nsearch: {gap: 2}\n"))]) == 2


@pytest.mark.parametrize(
    ("relations", "why"),
    [
        (
            "|(.(p1 p2))_[0-90000]",
            ("must end by 90.000 s", "it must wait for what is not done: `.(p1 p2)`"),
        ),
        ("|(p1_[0-9000] p2_[0-8000])", ("must end by 9.000 s", "must end by 8.000 s")),
        ("+(p1_[0-9000] p2_[0-8000])", ("must end by 9.000 s", "must end by 8.000 s")),
    ],
)
def test_where_nothing_can_be_done_each_task_has_its_reason(
    crossing, relations: str, why: tuple[str, ...]
) -> None:
    with pytest.raises(NoPlan) as error:
        make_plan(load(crossing(relations)))
    said = error.value.reasons
    assert len(said) == len(why)
    for number, (reason, part) in enumerate(zip(said, why, strict=True), 1):
        assert reason.startswith(f"task {number} (")
        assert part in reason


@pytest.mark.parametrize(
    "relations",
    [
        "|(p1_[0-9000] p2_[0-8000])",  # nothing can be done
        "|(p1_[0-9000] p2)",  # one of the two
    ],
)
def test_the_command_names_file_and_line(
    crossing, relations: str, capsys: pytest.CaptureFixture
) -> None:
    file = crossing(relations)
    line = 1 + file.read_text().splitlines().index(f'relations: "{relations}"')
    assert main(["plan", str(file), "--allow-unproved"]) == 1
    said = "".join(capsys.readouterr())
    assert f"(`p1_[0-9000]` at {file}:{line}: p1 ends at " in said


def test_planning_says_the_same_wherever_the_file_lies(crossing, tmp_path: Path) -> None:
    """What the services say enters the log, and so its digest."""
    text = crossing("|(p1_[0-9000] p2)").read_text(encoding="utf-8")
    heard = []
    for place in ("here", "there"):
        (tmp_path / place).mkdir()
        file = tmp_path / place / f"{place}.yaml"
        file.write_text(text, encoding="utf-8")
        mission, bus, said = load(file), Bus(lmcp.full_names), list[str]()
        bus.tap(lambda envelope, said=said: said.append(lmcp.to_json(envelope.body)))
        plan = make_plan(mission, bus)
        file.unlink()  # nor does it matter whether it is still there
        heard.append((plan, said))
    assert heard[0] == heard[1]
    assert any("must end by 9.000 s (`p1_[0-9000]`: " in one for one in heard[0][1])


def test_the_command_writes_what_the_other_checks(
    crossing, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    kept = tmp_path / "plan.json"
    file = str(crossing(".(p1 p2)"))
    assert main(["plan", file, "--allow-unproved", "--certificate", str(kept)]) in (0, 3)
    assert "optimal" in capsys.readouterr().out
    assert main(["certify-plan", str(kept)]) == 0
    assert "confirmed: optimal" in capsys.readouterr().out
    body = json.loads(kept.read_text())
    body["claim"]["cost"] -= 1
    kept.write_text(json.dumps(body))
    assert main(["certify-plan", str(kept)]) == 1
