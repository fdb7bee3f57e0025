"""From a report's verdicts to their proofs, as the page shows them."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest

from cratous.core import ledger
from cratous.services.certify.trace import traced
from cratous.services.ground_station.proof_chains import proofs_of
from cratous.spec.errors import BadInput


@pytest.fixture
def report(crossing: Path) -> dict[str, Any]:
    return dict(json.loads((crossing / "report.json").read_text(encoding="utf-8")))


def test_the_chains_are_those_of_certify_with_what_both_solvers_said(
    report: dict[str, Any],
) -> None:
    found = proofs_of(report, "report.json")
    rows = traced(report)["rows"]
    assert len(found["rows"]) == len(report["constraints"]) == len(rows)
    for row, expected in zip(found["rows"], rows, strict=True):
        assert [one["kernel"] for one in row["chains"]] == [c["kernel"] for c in expected["chains"]]
        assert row["missing"] == expected["missing"]
    known = ledger.read()["theorems"]
    named = {t for row in found["rows"] for one in row["chains"] for t in one["theorems"]}
    lemmas = {t for one in found["theorems"].values() for t in one["lemmas"]}
    assert named
    assert set(found["theorems"]) == named | lemmas
    for name, one in found["theorems"].items():
        assert one["sentence"] == known[name]["sentence"]
        # the second solver was asked for each obligation that the first one proved
        assert sum(one["cvc5"].values()) == known[name]["obligations"] == one["obligations"]
    assert found["same_ledger"]
    assert found["solvers"][1].startswith("cvc5 ")
    assert all(counts["killed"] for counts in found["mutants"].values())
    assert found["mutants"]


def test_another_ledger_and_kernels_without_a_proof_are_said(report: dict[str, Any]) -> None:
    changed = copy.deepcopy(report)
    changed["proofs"]["seal"] = "0" * 64
    kernel = changed["constraints"][0]["kernels"][0]
    changed["proofs"]["kernels"][kernel] |= {"against": [], "theorems": []}
    found = proofs_of(changed, "report.json")
    assert not found["same_ledger"]
    assert any("no theorem holds it" in text for text in found["rows"][0]["missing"])


@pytest.mark.parametrize("lacks", ["proofs", "constraints"])
def test_a_report_that_lacks_them_is_refused(report: dict[str, Any], lacks: str) -> None:
    del report[lacks]
    with pytest.raises(BadInput, match="proofs"):
        proofs_of(report, "report.json")
