"""The search through the composition of authority: every seeded fault is found, the safe design is safe."""

from __future__ import annotations

import ast
import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from cratous.core.authority.cycle import Cycle
from cratous.core.authority.gate import Gate
from cratous.core.authority.link_end import LinkEnd
from cratous.core.permit.hand import hand_after, hand_step
from cratous.proofs.system_search.authority import Design, State, steps
from cratous.proofs.system_search.breadth_first import search
from cratous.proofs.system_search.certificate_faults import HAND_FAULTS
from cratous.proofs.system_search.certificates import HandDesign, Held
from cratous.proofs.system_search.faults import FAULTS
from cratous.services.cli import main
from cratous.services.cli.search_faults import search_faults
from cratous.spec.errors import BadInput

THEOREMS = Path(__file__).parents[2] / "proofs" / "theorems" / "system"


def test_the_safe_design_is_safe_and_returns_control() -> None:
    found = search(Design(), 8)
    assert (found.wrong, found.trace) == ("", ())
    assert found.complete
    assert found.returned
    assert found.states > 1000


@pytest.mark.parametrize("name", sorted(FAULTS))
def test_each_fault_is_found_by_a_trace_that_the_design_can_do(name: str) -> None:
    design = FAULTS[name].design
    found = search(design, 8)
    assert found.wrong
    reached = {State()}
    for entry in found.trace[:-1]:
        reached = {
            one.after
            for state in reached
            for one in steps(design, state)
            if one.entry == entry and not one.wrong
        }
        assert reached
    last = [
        one
        for state in reached
        for one in steps(design, state)
        if one.entry == found.trace[-1] and one.wrong == found.wrong
    ]
    assert last


@pytest.mark.parametrize("name", sorted(FAULTS))
def test_no_shorter_trace_is_wrong(name: str) -> None:
    design = FAULTS[name].design
    length = len(search(design, 8).trace)
    if length > 1:
        assert not search(design, length - 1).wrong


def test_the_theorems_and_the_search_are_about_the_same_kernels() -> None:
    """What the search steps by is what the theorems of the system are proved of."""
    default = Design()
    searched = {
        one.__name__ for one in vars(default).values() if getattr(one, "__name__", "") != ""
    } - {"track_is_told", "taken_epoch"}  # when UxAS sends, and what its executive remembers
    proved = set()
    for file in THEOREMS.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ImportFrom) and "core.authority" in str(node.module):
                proved |= {alias.name for alias in node.names}
    assert searched <= proved


def test_the_safe_certificate_is_safe_and_one_is_in_hand_again_after_a_surprise() -> None:
    found = search(HandDesign(), 6)
    assert (found.wrong, found.trace) == ("", ())
    assert found.complete
    assert found.returned
    assert found.states > 10_000


@pytest.mark.parametrize("name", sorted(HAND_FAULTS))
def test_each_fault_of_a_certificate_is_found_by_a_shortest_trace(name: str) -> None:
    design = HAND_FAULTS[name].design
    found = search(design, 6)
    assert found.wrong
    reached = {Held()}
    for entry in found.trace:
        reached = {
            one.after
            for state in reached
            for one in design.steps(state)
            if one.entry == entry and bool(one.wrong) == (entry is found.trace[-1])
        }
        assert reached
    assert not search(design, len(found.trace) - 1).wrong


def test_the_theorem_and_the_search_are_about_the_same_hand() -> None:
    text = (THEOREMS / "the_hand_is_clear_until_a_surprise_or_its_expiry.py").read_text()
    assert HandDesign().step is hand_step
    assert "hand_after" in text
    assert hand_after.step is hand_step


def test_bounds_are_asked_for() -> None:
    with pytest.raises(BadInput, match="most_steps"):
        search(Design(), 0)
    few = search(Design(), 8, 50)
    assert not few.complete
    assert not few.wrong


def test_a_state_begins_as_the_theorem_says() -> None:
    state = State()
    assert state.gate == Gate(0, 0, False)
    assert state.cycle == Cycle(0, 0, False, 0, False, 0)
    assert state.end == LinkEnd(False, 0, True)


def test_the_command_tells_traces_and_bounds() -> None:
    run = CliRunner().invoke(search_faults, ["no-acknowledgement", "safe"])
    assert run.exit_code == 0, run.output
    assert "two command in one epoch" in run.output
    assert "which is no proof" in run.output
    few = CliRunner().invoke(search_faults, ["safe", "--states", "50", "--json"])
    assert few.exit_code == 3
    assert json.loads(few.output)["designs"][0]["complete"] is False
    short = CliRunner().invoke(search_faults, ["no-acknowledgement", "--steps", "2"])
    assert short.exit_code == 3
    assert main(["search-faults", "no-such-design"]) == 2
