"""Recalled theorems: only what was proved, only from the very same files."""

from __future__ import annotations

from pathlib import Path

import pytest

from cratous.core import ledger as gate
from cratous.core.kernel.sources import ROOT
from cratous.proofs import ledger
from cratous.proofs.claim import Claim
from cratous.proofs.engine import prover
from cratous.proofs.ledger import recall, remembered
from cratous.proofs.ledger.recall import Recall, files, key
from cratous.proofs.ledger.remembered import Remembered
from cratous.spec.errors import BadInput

NAME = "daa_height_follows_the_climb"
gate.load_all()


@pytest.fixture
def memory(tmp_path: Path) -> Recall:
    return Recall(tmp_path / "theorems")


def stored(memory: Recall) -> Path:
    assert memory.folder is not None
    (file,) = [f for f in memory.folder.rglob("*") if f.is_file()]
    return file


def test_a_proved_theorem_is_recalled_as_it_was_and_not_stated_again(memory, monkeypatch):
    name = "authority_the_greater_id_gives_way"
    first = ledger.prove_all([name], recall=memory)

    def again(*more):
        raise AssertionError("it was stated again")

    monkeypatch.setattr(prover, "state", again)
    heard = []
    second = ledger.prove_all([name], heard.append, recall=memory)
    assert second.theorems == first.theorems
    assert [p.theorem for p in heard] == list(first.theorems)
    assert ledger.prove_all([], recall=memory).theorems == ()


@pytest.mark.parametrize(
    "place",
    [
        "proofs/theorems/daa/height_follows_the_climb.py",
        "proofs/theorems/daa/climb_is_flown.py",
        "core/daa/climb.py",
        "spec/daa/meaning.py",
        "core/kernel/__init__.py",
        "proofs/engine/prover.py",
        "proofs/engine/lift.py",
        "proofs/ledger/recall.py",
    ],
)
def test_a_change_of_any_file_behind_it_is_another_theorem(place, monkeypatch):
    before, real = key(NAME), recall._hash
    changed = ROOT / place
    assert changed.is_file()
    monkeypatch.setattr(recall, "_hash", lambda f: "other" if f == changed else real(f))
    assert key(NAME) != before


def test_a_change_elsewhere_is_none(monkeypatch):
    before, real = key(NAME), recall._hash
    elsewhere = (
        ROOT / "core/authority/gate.py",
        ROOT / "spec/authority/gate.py",
        ROOT / "core/readings/machine/compiled.py",
    )
    monkeypatch.setattr(recall, "_hash", lambda f: "other" if f in elsewhere else real(f))
    assert key(NAME) == before


def test_a_theorem_about_whatever_is_registered_depends_on_every_file():
    every = set(files("filter_graphs_are_the_kernels"))
    assert {*(ROOT / "core").rglob("*.py"), *(ROOT / "spec").rglob("*.py")} <= every
    assert set(files(NAME)) < every


@pytest.mark.parametrize(
    "line",
    [
        "import importlib",
        "from cratous.core.kernel import REGISTRY",
        "from cratous.core.kernel.sources import reached",
        "from cratous.core import compiled",
        "text = open(__file__).read()",
    ],
)
def test_so_does_a_theorem_whose_file_asks_for_more_than_it_imports(line, tmp_path, monkeypatch):
    real = gate.theorem_file(NAME, gate.PRODUCT)
    changed = tmp_path / real.name
    changed.write_text(f"{line}\n{real.read_text()}")
    place = gate.theorem_file
    found = lambda name, home: changed if name == NAME else place(name, home)  # noqa: E731
    monkeypatch.setattr(gate, "theorem_file", found)
    assert {*(ROOT / "core").rglob("*.py")} <= set(files(NAME))


def test_tools_for_arrays_behind_a_kernel_are_no_reason_to(monkeypatch):
    found = set(files("well_clear_within_during_scales"))
    assert {ROOT / "core/readings/machine/compiled.py", ROOT / "core/well_clear/during.py"} <= found
    assert ROOT / "core/authority/gate.py" not in found


@pytest.mark.parametrize("what", ["solver_version", "python_version"])
def test_another_version_is_another_theorem(what, monkeypatch):
    before = key(NAME)
    owner = recall.gate if what == "solver_version" else recall.platform
    monkeypatch.setattr(owner, what, lambda: "0.0")
    assert key(NAME) != before


def test_what_is_damaged_or_another_theorem_s_counts_as_absent(memory):
    one, other = "authority_the_greater_id_gives_way", "authority_exactly_one_gives_way"
    memory.put(ledger.prove_theorems([one]))
    file = stored(memory)
    text = file.read_text()
    assert memory.get(one) is not None
    for wrong in ("", "{}", text[:-9], text.replace(one, other), text.replace('"kernels"', '"x"')):
        file.write_text(wrong)
        assert memory.get(one) is None
    elsewhere = file.parent.parent / key(other)[:2] / key(other)
    elsewhere.parent.mkdir(exist_ok=True)
    elsewhere.write_text(text)
    assert memory.get(other) is None


def test_what_is_not_proved_is_not_kept(memory, monkeypatch):
    def claim(c: Claim) -> None:
        from cratous.core.authority.gate import gives_way

        c.show(c.use(gives_way, c.integer("a"), c.integer("b"), True))

    with monkeypatch.context() as patch:
        patch.setattr(prover, "load_claim", lambda *more: (claim, "It always does."))
        found = ledger.prove_all(["authority_the_greater_id_gives_way"], recall=memory)
    assert not found.theorems[0].proved
    assert memory.get("authority_the_greater_id_gives_way") is None
    # nor is a file that says so believed
    memory.put(ledger.prove_theorems(["authority_exactly_one_gives_way"]))
    file = stored(memory)
    file.write_text(file.read_text().replace('"status": "proved"', '"status": "refuted"'))
    assert memory.get("authority_exactly_one_gives_way") is None


def test_a_definition_whose_running_code_is_not_its_file_s_is_no_ground_for_a_proof(monkeypatch):
    from cratous.spec.authority import gate as authority

    monkeypatch.setattr(
        authority.may_command, "__code__", (lambda state, sender: sender == 0).__code__
    )
    with pytest.raises(BadInput, match=r"not its file's: cratous\.spec\.authority"):
        prover.state("authority_gate_has_exactly_one_commander")


# -- texts that follow from the files alone ---------------------------------------------------
def test_a_remembered_text_is_made_again_when_its_inputs_change(tmp_path):
    made = []

    def make() -> str:
        made.append(len(made))
        return f"made {len(made)}"

    memory = Remembered(tmp_path / "remembered", gate.PRODUCT)
    assert [memory.text("a", "1", make), memory.text("a", "1", make)] == ["made 1", "made 1"]
    assert memory.text("a", "2", make) == "made 2"
    assert memory.text("b", "2", make) == "made 3"
    (tmp_path / "remembered" / "b").write_text('{"key": "another"', encoding="utf-8")
    assert memory.text("b", "2", make) == "made 4"
    assert Remembered(None, gate.PRODUCT).text("b", "2", make) == "made 5"


def test_what_is_remembered_depends_on_every_file_of_the_product(monkeypatch):
    hashed = set()
    monkeypatch.setattr(remembered, "named", lambda file: hashed.add(file) or str(file))
    remembered.product.__wrapped__(gate.PRODUCT)
    assert {file.name for file in hashed} >= {
        "polygon.py",
        "decisions.json",
        "prove.py",
        "tcp_port.py",
    }
    assert not any(file.name == "ledger.json" for file in hashed)
