"""What the key of a mutation verdict follows: the judging code and what is judged, and nothing beside them."""

import functools
from pathlib import Path

import pytest

from cratous.core import ledger as gate
from cratous.core.ledger import keys as ledger_keys
from cratous.core.ledger.package_home import PRODUCT
from cratous.proofs.mutation.keys import LOOKED_UP, Keys, find

TARGET = "cratous.core.authority.gate.gate_accepts"
THEOREM = "authority_gate_changes_begin_epochs"


@functools.cache
def keys_with(file: str = "", old: str = "", new: str = "") -> tuple[str, str]:
    """The keys of the judging code and of a target, with one text in a file replaced by another."""
    gate.load_all()
    one = Keys(theorems=[THEOREM])
    if file:
        path = Path(PRODUCT.root, file)
        text = path.read_text(encoding="utf-8")
        assert old in text
        edits = {path: text.replace(old, new, 1).encode()}
        one._keys = ledger_keys.Keys(edits=edits)
    return one.judging, one.target(TARGET, find(TARGET))


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("core/routing/visibility.py", "\n\n\ndef ", "\n\n\nANOTHER = 4\n\n\ndef "),
        (
            "proofs/theorems/merging/slots_are_apart_and_in_their_windows.py",
            "MOST = 1 << 60",
            "MOST = 1 << 59",
        ),
    ],
)
def test_a_change_elsewhere_leaves_a_verdict_valid(file: str, old: str, new: str) -> None:
    assert keys_with(file, old, new) == keys_with()


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("proofs/mutation/judgement.py", "LOOKED_AT, MANY = 8, 100", "LOOKED_AT, MANY = 9, 100"),
        ("proofs/mutation/operators.py", "def _negated(", "def _negated(*_: int, "),
        ("proofs/mutation/terms.py", "NEAR", "NEARER"),
        ("proofs/engine/lift.py", "raise ", "raise not "),
    ],
)
def test_a_change_of_the_judging_code_makes_a_verdict_stale(file: str, old: str, new: str) -> None:
    assert keys_with(file, old, new)[0] != keys_with()[0]
    assert keys_with(file, old, new)[1] != keys_with()[1]


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("core/authority/gate.py", "sender", "from_whom"),
        ("proofs/theorems/authority/gate_changes_begin_epochs.py", "c.show(", "c.premise("),
        ("spec/authority/gate.py", "return ", "return not "),
    ],
)
def test_a_change_of_what_is_judged_makes_its_verdict_stale(file: str, old: str, new: str) -> None:
    assert keys_with(file, old, new)[1] != keys_with()[1]


def test_each_look_up_that_is_not_followed_is_there() -> None:
    one = Keys()
    tree, met = one._keys.tree, {one._keys.name(place): place for place in one.judges.places}
    for name, (words, reason) in LOOKED_UP.items():
        assert set(words) <= set(tree.unit(met[f"cratous.{name}"]).asks), name
        assert len(reason) >= 20
