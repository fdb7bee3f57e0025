"""Recalled theorems: only what was proved, only of the very same definitions."""

from __future__ import annotations

from pathlib import Path

import pytest

from cratous.core import ledger as gate
from cratous.core.kernel.sources import ROOT
from cratous.core.ledger import key_parts
from cratous.core.ledger.keys import Keys
from cratous.proofs import ledger
from cratous.proofs.claim import Claim
from cratous.proofs.engine import prover
from cratous.proofs.ledger import proof_recall, text_cache
from cratous.proofs.ledger.proof_recall import Recall
from cratous.proofs.ledger.text_cache import Remembered
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


@pytest.fixture(scope="module")
def plain() -> Recall:
    return Recall(None)


def _edited(place: str, old: str, new: str) -> Recall:
    text = (ROOT / place).read_text()
    assert old in text, f"{old!r} is not in {place}: this case needs an update"
    return Recall(None, keys=Keys(edits={ROOT / place: text.replace(old, new, 1).encode()}))


@pytest.mark.parametrize(
    ("place", "old", "new"),
    [
        ("proofs/theorems/daa/height_follows_the_climb.py", "c.premise(", "c.premise(True or "),
        ("proofs/theorems/daa/climb_is_flown.py", "c.premise(", "c.premise(True or "),
        ("core/daa/climb.py", "return ", "return 0 + "),
        ("core/kernel/__init__.py", "x: float\n    y: float", "y: float\n    x: float"),
        ("proofs/engine/prover.py", '"unsat": "proved"', '"sat": "proved"'),
        (
            "proofs/engine/lift.py",
            "def lift(",
            "def lift_(x):\n    return x\n\n\n@lift_\ndef lift(",
        ),
    ],
)
def test_a_change_of_what_is_behind_it_is_another_theorem(place, old, new, plain):
    assert _edited(place, old, new).key(NAME) != plain.key(NAME)


@pytest.mark.parametrize(
    ("place", "old", "new"),
    [
        ("core/authority/gate.py", "gate.epoch + 1", "gate.epoch + 2"),
        ("spec/authority/gate.py", "return ", "return 0 or "),
        ("core/daa/climb.py", "\n\n\n", "\n\n\nUNUSED = 1\n\n\n"),
        ("proofs/ledger/proof_recall.py", "file.is_file()", "file.exists()"),
    ],
)
def test_a_change_elsewhere_is_none(place, old, new, plain):
    assert _edited(place, old, new).key(NAME) == plain.key(NAME)


def test_a_theorem_about_whatever_is_registered_depends_on_every_kernel(plain):
    name = "filter_graphs_are_the_kernels"
    changed = _edited("core/authority/gate.py", "gate.epoch + 1", "gate.epoch + 2")
    assert changed.key(name) != plain.key(name)


@pytest.mark.parametrize(
    "line",
    [
        "import importlib\nimportlib.import_module('far')",
        "from cratous.core.kernel import REGISTRY\nprint(REGISTRY)",
        "print(open(__file__).read())",
        "import sys\nsys.modules['far']",
    ],
)
def test_a_theorem_that_asks_for_more_than_it_names_depends_on_everything(line):
    place = ROOT / "proofs/theorems/daa/height_follows_the_climb.py"
    asking = {place: place.read_text().replace("def claim(", f"{line}\n\n\ndef claim(").encode()}
    elsewhere = ROOT / "core/authority/gate.py"
    more = {**asking, elsewhere: elsewhere.read_bytes() + b"\nMORE = 1\n"}
    assert Recall(None, keys=Keys(edits=asking)).key(NAME) != Recall(
        None, keys=Keys(edits=more)
    ).key(NAME)


@pytest.mark.parametrize("what", ["z3-solver", "python_version"])
def test_another_version_is_another_theorem(what, monkeypatch, plain):
    before = plain.key(NAME)
    if what == "python_version":
        monkeypatch.setattr(proof_recall.platform, what, lambda: "0.0")
    else:
        monkeypatch.setattr(key_parts, "version", lambda name: "0.0")
    assert Recall(None).key(NAME) != before


def test_what_is_damaged_or_another_theorem_s_counts_as_absent(memory):
    one, other = "authority_the_greater_id_gives_way", "authority_exactly_one_gives_way"
    memory.put(ledger.prove_theorems([one]))
    file = stored(memory)
    text = file.read_text()
    assert memory.get(one) is not None
    for wrong in ("", "{}", text[:-9], text.replace(one, other), text.replace('"kernels"', '"x"')):
        file.write_text(wrong)
        assert memory.get(one) is None
    elsewhere = file.parent.parent / memory.key(other)[:2] / memory.key(other)
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
    with pytest.raises(
        BadInput, match=r"spec\.authority\.gate\.may_command, .*the code that runs is that of"
    ):
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
    monkeypatch.setattr(text_cache, "named", lambda file: hashed.add(file) or str(file))
    text_cache.product.__wrapped__(gate.PRODUCT)
    assert {file.name for file in hashed} >= {
        "polygon.py",
        "decisions.json",
        "prove.py",
        "tcp_port.py",
    }
    assert not any("records" in file.parts for file in hashed)
