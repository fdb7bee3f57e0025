"""A theorem that cannot be stated is told: where, and what to do about it."""

from __future__ import annotations

from pathlib import Path

import pytest

from cratous.proofs import ledger
from cratous.proofs.engine import prover
from cratous.spec.errors import BadInput


def test_a_term_that_is_nested_too_deeply_is_told(tmp_path: Path):
    lines = [
        '"""A sentence."""',
        "from cratous.core.well_clear import vertical_violation",
        "def claim(c):",
        "    a, b, d = c.reals('a b d')",
        "    for _ in range(20_000):",
        "        a = a * b + d",
        "    c.show(c.use(vertical_violation, a, b, d, d))",
    ]
    (tmp_path / "deep.py").write_text("\n".join(lines))
    with pytest.raises(BadInput, match=r"nested too deeply") as caught:
        prover.prove_file("deep", folder=tmp_path)
    assert caught.value.expected.startswith("less in one kernel")


def test_a_statement_without_an_end_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(prover, "STATE_CPU_S", 1)
    text = '"""A sentence."""\n\n\ndef claim(c):\n    for k in range(10**12):\n        x = k\n'
    (tmp_path / "endless.py").write_text(text)
    with pytest.raises(BadInput, match=r"endless.py: .* its paths take too long") as caught:
        prover.prove_file("endless", folder=tmp_path)
    assert caught.value.got == "more than 1 s of CPU"
    # nothing of it is left: the next theorem is stated as ever
    (theorem,) = ledger.prove_theorems(["geofence_straddles_is_its_definition"], jobs=1)
    assert theorem.proved


def test_a_mistake_in_a_theorem_is_told_with_its_line(tmp_path: Path):
    (tmp_path / "slip.py").write_text('"""A sentence."""\n\n\ndef claim(c):\n    c.shows(True)\n')
    with pytest.raises(BadInput, match=r"slip.py:5: a theorem's file does not have .*'shows'"):
        prover.prove_file("slip", folder=tmp_path)
    (tmp_path / "user.py").write_text('"""A sentence."""\n\n\ndef claim(c):\n    c.lemma("slip")\n')
    with pytest.raises(BadInput, match=r"slip.py:5: a theorem's file does not have .*'shows'"):
        prover.prove_file("user", folder=tmp_path)
