"""What kernels name as their definitions: there, used, related by a goal, and not the kernel itself."""

from __future__ import annotations

import functools
import os
import signal
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from cratous.core import kernel as kernels
from cratous.core import ledger
from cratous.core.files.private_cache import private_cache
from cratous.core.kernel import REGISTRY, Entry, named, supported
from cratous.core.ledger import PRODUCT
from cratous.proofs.engine import prover
from cratous.proofs.engine.reachable_paths import ALL, NOT
from cratous.proofs.statements import relation_cache
from cratous.proofs.statements.closed_definitions import full_name
from cratous.proofs.statements.decided import Decided, Group
from cratous.proofs.statements.definitions import (
    Proofs,
    definition,
    definition_name,
    is_restated,
    problems,
    to_decide,
    with_decided,
)
from cratous.proofs.statements.relation_cache import Kept, readers
from cratous.proofs.statements.relations import Relations, relations

ENTRIES = ledger.load_all()
NOTHING = Relations(frozenset(), frozenset(), frozenset(), frozenset(), ())


def test_every_kernel_of_the_product_has_a_definition_or_is_a_step_of_one_that_has() -> None:
    for name, entry in ENTRIES.items():
        if entry.kind == "driver":
            continue
        if entry.supports:
            assert REGISTRY[supported(entry)].implements, name
        else:
            assert definition(entry, PRODUCT) is not None, f"{name}: {entry.implements}"
            assert bool(entry.restates) == bool(is_restated(entry, PRODUCT)), name


@pytest.mark.slow  # it reads the statement of each theorem
def test_each_definition_is_used_and_related_by_a_theorem() -> None:
    data = ledger.read()["theorems"]
    kept = Kept(private_cache() / "relations", PRODUCT)
    related = kept.all(prover.theorem_files(), jobs=2)
    # that their arguments vary is asked when they are proved
    varied = {name: {use[2:]: ALL for use in one.uses} for name, one in related.items()}
    proofs = Proofs(
        {name: tuple(record["kernels"]) for name, record in data.items()},
        frozenset(name for name, record in data.items() if record["status"] == "proved"),
        related,
        varied,
    )
    ask = functools.partial(kept.decided, jobs=2)
    proofs = with_decided(ENTRIES, PRODUCT, proofs, ask)
    assert problems(ENTRIES, PRODUCT, proofs) == []


def test_what_is_kept_of_a_statement_depends_on_all_that_reads_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = Kept(tmp_path, PRODUCT)
    before = kept._file("authority_exactly_one_gives_way")
    assert before == kept._file("authority_exactly_one_gives_way")
    there = {file.name: file for file in readers()}
    for name in ("relations.py", "sentences.py", "closed_definitions.py", "premise_and_goal.py"):
        changed = tmp_path / name
        changed.write_text(there[name].read_text(encoding="utf-8") + "\n# another\n")
        files = [changed if file.name == name else file for file in there.values()]
        monkeypatch.setattr(relation_cache, "readers", lambda files=files: files)
        assert kept._file("authority_exactly_one_gives_way") != before, name


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_theorem_whose_process_is_ended_decides_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, jobs: int
) -> None:
    names = sorted(prover.theorem_files())[:4]
    said = frozenset([("spec.meant", "core.kernel", 0)])

    def decide(name: str, folder: Path, seed: str, wanted: object) -> frozenset[Decided]:
        if name == names[1]:
            os.kill(os.getpid(), signal.SIGXCPU)
        return said

    monkeypatch.setattr(relation_cache.decided, "decided", decide)
    kept = Kept(tmp_path, PRODUCT)
    wanted: dict[str, list[Group]] = {name: [("spec.meant", {})] for name in names}
    found = kept.decided(wanted, jobs)
    assert found == {name: frozenset() if name == names[1] else said for name in names}
    # an answer is kept, its lack is not
    assert len([file for file in tmp_path.rglob("*") if file.is_file()]) == 3
    assert kept.decided(wanted, jobs) == found


# -- what is wrong is said -------------------------------------------------------------------
def _said(entry: Entry, proofs: Proofs) -> str:
    found = problems({entry.name: entry}, PRODUCT, proofs)
    assert len(found) == 1, found
    return found[0]


def _proofs(
    name: str, uses: str = "", *, proved: bool = True, lemma: str = "", how: str = ALL
) -> Proofs:
    """One theorem about a kernel; it, or its lemma, uses a definition. how: the arguments vary."""
    full = "nobody" if name == "nobody" else named(name).name
    using = replace(
        NOTHING,
        definitions=frozenset([uses]),
        together=frozenset([(full, uses)]),
        uses=frozenset([(full, uses, full, 0)]),
        plain=frozenset([(full, uses, full, 0)]),
    )
    said = {"one": using} if not lemma else {"one": replace(NOTHING, lemmas=(lemma,)), lemma: using}
    varied = {theorem: {(full, 0): how} for theorem in said}
    return Proofs({"one": (full,)}, frozenset(["one"] if proved else []), said, varied)


def test_a_definition_that_is_not_there() -> None:
    later = named("later")
    proofs = _proofs("later", definition_name(later, PRODUCT))
    assert problems({"later": later}, PRODUCT, proofs) == []
    said = _said(replace(later, implements="schedule.latest_of"), proofs)
    assert "core/schedule/rows.py" in said
    assert "later: implements 'schedule.latest_of', but spec has no such function" in said
    assert "no spec/times.py" in _said(replace(later, implements="times.later_of"), proofs)
    # a name that the module only imports, and one that is no function
    for name in ("schedule.NamedTuple", "schedule.NOT_BEFORE"):
        assert "no such function" in _said(replace(later, implements=name), proofs)


def test_a_definition_that_no_theorem_uses() -> None:
    later = named("later")
    used = definition_name(later, PRODUCT)
    for idle in (_proofs("later", "cratous.spec.schedule.earlier_of"), _proofs("earlier", used)):
        assert "which none of its theorems uses" in _said(later, idle)
    assert problems({"later": later}, PRODUCT, _proofs("later", used, lemma="two")) == []
    for fixed in (NOT, "3"):
        said = _said(later, _proofs("later", used, how=fixed))
        assert "holds it against for more than one value of each argument" in said
    for few, points in (("not 2", "2 points"), ("not 9", "more than 8 points, all apart")):
        said = _said(later, _proofs("later", used, how=few))
        assert f"its premises leave an argument {points}" in said


def test_goals_with_conditions_are_looked_at_further() -> None:
    later = named("later")
    used, full = definition_name(later, PRODUCT), later.name
    found = _proofs("later", used)
    assert to_decide({"later": later}, PRODUCT, found) == {}
    (using,) = found.relations.values()
    conditional = replace(found, relations={"one": replace(using, plain=frozenset())})
    wanted = {"one": [((full, used), {(full, 0): ALL})]}
    assert to_decide({"later": later}, PRODUCT, conditional) == wanted
    assert "goals have conditions" in _said(later, conditional)
    decided = {"one": frozenset([(used, full, 0)])}
    assert problems({"later": later}, PRODUCT, replace(conditional, decided=decided)) == []
    other = {"one": frozenset([("cratous.spec.schedule.earlier_of", full, 0)])}
    assert "goals have conditions" in _said(later, replace(conditional, decided=other))


def test_one_theorem_is_asked_for_each_kernel_in_a_round() -> None:
    later = named("later")
    used, full = definition_name(later, PRODUCT), later.name
    found = _proofs("later", used)
    using = replace(found.relations["one"], plain=frozenset(), statement="later is x")
    long = replace(using, statement="for all x, later(x) is x")
    more = replace(using, uses=using.uses | {(full, used, full, 1)})
    relations = {"a": long, "b": using, "c": using, "d": more}
    several = replace(
        found,
        kernels=dict.fromkeys("abcd", (full,)),
        relations=relations,
        varied={name: {(full, 0): ALL} for name in "abcd"},
    )
    decides = frozenset([(used, full, 0)])

    def rounds(proofs: Proofs, deciding: str) -> tuple[list[list[str]], Proofs]:
        asked: list[list[str]] = []

        def ask(wanted: Mapping[str, list[Group]]) -> dict[str, frozenset[Decided]]:
            asked.append(list(wanted))
            return {name: decides if name in deciding else frozenset() for name in wanted}

        known = with_decided({"later": later}, PRODUCT, proofs, ask)
        return asked, known

    # the shortest comes first, then what uses least, then by name
    for deciding, wanted in (("b", "b"), ("c", "bc"), ("ad", "bcd"), ("", "bcda")):
        asked, known = rounds(several, deciding)
        assert asked == [[name] for name in wanted]
        assert (problems({"later": later}, PRODUCT, known) == []) == bool(deciding)
    # one that was not run holds nothing alone, so it is asked last, and does not end the rounds
    for deciding, wanted in (("ab", "cda"), ("b", "cdab")):
        asked, known = rounds(replace(several, run=frozenset("acd")), deciding)
        assert asked == [[name] for name in wanted]
        assert (problems({"later": later}, PRODUCT, known) == []) == ("a" in deciding)


def test_what_assumes_something_vouches_for_nothing() -> None:
    later = named("later")
    used = definition_name(later, PRODUCT)
    for proofs, assuming in (
        (_proofs("later", used), "one"),
        (_proofs("later", used, lemma="two"), "two"),
    ):
        found = replace(proofs, assuming=frozenset([assuming]))
        assert "without an assumption" in _said(later, found)
        assert to_decide({"later": later}, PRODUCT, found) == {}


def test_a_theorem_that_was_run_at_no_point_of_doubles() -> None:
    later = named("later")
    proofs = _proofs("later", definition_name(later, PRODUCT))
    assert problems({"later": later}, PRODUCT, replace(proofs, run=frozenset(["one"]))) == []
    said = _said(later, replace(proofs, run=frozenset()))
    assert "no point of doubles was found" in said


def test_a_definition_that_no_theorem_holds_it_against() -> None:
    later = named("later")
    used = definition_name(later, PRODUCT)
    found = _proofs("later", used)
    (using,) = found.relations.values()
    idle = replace(found, relations={"one": replace(using, together=frozenset())})
    assert "which none of its theorems holds it against" in _said(later, idle)


def test_a_definition_with_the_kernels_own_formula() -> None:
    enough = named("enough")
    proofs = _proofs("enough", definition_name(enough, PRODUCT))
    assert problems({"enough": enough}, PRODUCT, proofs) == []
    assert "has its own formula" in _said(replace(enough, restates=""), proofs)
    later = replace(named("later"), restates="the later of two")
    proofs = _proofs("later", definition_name(later, PRODUCT))
    assert "has another formula: it restates nothing" in _said(later, proofs)


def test_a_fold_restates_with_its_step() -> None:
    fold = replace(named("way_conflicts"), implements="geofence.any_step")
    assert is_restated(fold, PRODUCT)
    assert not is_restated(named("way_conflicts"), PRODUCT)


def test_a_step_of_what_does_not_carry_it() -> None:
    step = named("location_step")
    assert problems({step.name: step}, PRODUCT, _proofs("locate")) == []
    for whole, wanted in {
        "nobody": "which is no kernel or fold",
        "resolve": "which is no kernel or fold",
        "orient": "which does not call it",
    }.items():
        said = _said(replace(step, supports=whole), _proofs(whole))
        assert f"location_step: supports {whole!r}, {wanted}" in said
    cross = replace(named("orient"), implements="", supports="location_step")
    assert "which has no definition itself" in _said(cross, _proofs("location_step"))
    assert "which is not proved" in _said(step, _proofs("locate", proved=False))
    assert "which is not proved" in _said(step, _proofs("covers"))


def test_exactly_one_of_definition_and_whole_is_named() -> None:
    def half(a: float) -> float:
        """Half."""
        return a / 2

    for how in ({}, {"implements": "a.b", "supports": "c"}):
        with pytest.raises(ValueError, match="one of the two"):
            kernels.kernel(**how)(half)
    with pytest.raises(ValueError, match="restates no definition"):
        kernels.kernel(supports="c", restates="what it is for")(half)


# -- what a statement relates ----------------------------------------------------------------
@pytest.mark.parametrize(
    ("theorem", "kernel", "meant", "how"),
    [
        ("authority_gate_changes_begin_epochs", "gate_takeover", "authority.gate.is_takeover", "together"),
        # handed to a helper, inside a fold's own step, through folds over a closed chain
        ("schedule_holds_is_its_definition", "schedule_holds", "schedule.rows_hold_step", "together"),
        ("geofence_boundary_distance_is_that_of_the_nearest_edge", "boundary_distance",
         "geofence.least_step", "together"),
        # of a fold without a finish the accumulator is the result
        ("geofence_boundary_verdict_is_its_definition", "boundary_against", "geofence.against", "together"),
        # a table of numbers, evaluated while it is stated
        pytest.param(
            "contracts_tasks_move_as_the_table_says", "task_step", "contracts.tasks.row", "together",
            marks=pytest.mark.long,
        ),
    ],
)  # fmt: skip
def test_what_is_related(theorem: str, kernel: str, meant: str, how: str) -> None:
    pair = (full_name(named(kernel).function), f"cratous.spec.{meant}")
    found = relations(theorem)
    assert pair in getattr(found, how)
    assert pair[1] in found.definitions


def test_what_is_used_is_not_yet_related() -> None:
    found = relations("authority_exactly_one_gives_way")
    gives = full_name(named("gives_way").function)
    assert found.together == {(gives, "cratous.spec.authority.gate.one_gives_way")}
    assert not found.follows
    assert not found.leads
    # a theorem that compares kernels speaks of no definition
    found = relations("well_clear_times_tcpa_are_the_interval")
    assert found.definitions == frozenset()
    assert found.together == frozenset()


def test_lemmas_are_listed() -> None:
    found = relations("well_clear_cylinder_times_are_exact")
    assert "well_clear_times_tep_are_exact" in found.lemmas
