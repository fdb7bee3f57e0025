"""The outcome of a run in one word, from its result and the campaign's requirements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cratous.services.campaign.runs import Run
from cratous.services.requirements.requirement_files import TAKEN
from cratous.spec.mission.guarantees import Outcome, worst

DISAGREE, MISFIT, LOST = "disagreement", "misfit", "lost"
NO_PLAN, IMPOSSIBLE, FAILED = "no plan", "impossible", "failed"
ORDER = (
    DISAGREE, MISFIT, str(Outcome.VIOLATED), NO_PLAN, FAILED, LOST, str(Outcome.UNKNOWN),
    str(Outcome.EXCUSED), IMPOSSIBLE, str(Outcome.HOLDS),
)  # fmt: skip
"""The outcomes, worst first."""
BAD = (DISAGREE, MISFIT, str(Outcome.VIOLATED), NO_PLAN)
"""Outcomes that give a campaign the exit code 1; all others except `holds` give 3."""
MEANING = {
    DISAGREE: "judge and monitor do not say the same: one of them is wrong",
    MISFIT: "an event of its log is no step of the proved system, so no theorem on authority speaks of it",
    "violated": "a requirement is violated",
    NO_PLAN: "no plan exists, so nothing was flown",
    FAILED: "an internal error ended it",
    LOST: "every attempt at it was lost, so it was not flown",
    "unknown": "a requirement was not decided",
    "excused": "well clear or a constraint was lost where no way out existed",
    IMPOSSIBLE: "the mission is refused as it was made, so nothing was flown",
    "holds": "every requirement holds",
}


@dataclass(frozen=True)
class Row:
    """A run with its result (None: every attempt was lost) and its outcome."""

    run: Run
    result: dict[str, Any] | None
    outcome: str

    @property
    def flown(self) -> bool:
        """Whether it was flown to an end."""
        return self.result is not None and self.result["kind"] == "flown"

    def requirement(self, name: str) -> dict[str, Any] | None:
        """Verdict, margin and place of a requirement; None unless it was flown."""
        if self.result is None or not self.flown:
            return None
        found: dict[str, Any] | None = self.result["requirements"].get(name)
        return found

    @property
    def drawn(self) -> dict[str, Any]:
        """Values drawn for it, by the campaign or by the mission's own variants."""
        own = self.result.get("drawn", {}) if self.result else {}
        return {**self.run.drawn, **own}

    @property
    def why(self) -> str:
        """Why it does not hold, in words."""
        result = self.result or {}
        if "why" in result:
            return "; ".join(result["why"])
        judge = result.get("judge") or {}
        said = [
            f"{d['guarantee']} {d['item']}: judge {d['judge']}, monitor {d['monitor']}"
            for d in judge.get("disagreements", [])
        ]
        if "refused" in judge:
            said.append(f"the judge cannot read its log: {judge['refused']}")
        if (result.get("model") or {}).get("fits") is False:
            said.append(f"its log does not fit the model: {result['model']['why']}")
        for name, row in result.get("requirements", {}).items():
            if row["verdict"] != Outcome.HOLDS:
                said.append(f"{name} {row['verdict']}: {row['item']}: {row.get('note', '')}")
        return "; ".join(said) + ("; kernels without proof" * (not result.get("proved", True)))


def row_of(run: Run, result: dict[str, Any] | None, requirements: tuple[str, ...]) -> Row:
    """The row of a run."""
    return Row(run, result, outcome_of(result, requirements))


def outcome_of(result: dict[str, Any] | None, requirements: tuple[str, ...]) -> str:
    """The outcome of a result; undecided never counts as holding.

    A guarantee has to hold for the judge too; the judge does not know user requirements.
    """
    if result is None:
        return LOST
    if result["kind"] != "flown":
        return str(result["kind"])
    judge = result["judge"]
    if judge is not None and _disagrees(judge, requirements):
        return DISAGREE
    if (result.get("model") or {}).get("fits") is False:
        return MISFIT
    found = [Outcome.HOLDS if result["proved"] else Outcome.UNKNOWN]
    for name in requirements:
        verdict = Outcome(result["requirements"][name]["verdict"])
        if judge is not None and verdict is Outcome.HOLDS and TAKEN.fullmatch(name):
            verdict = Outcome(judge.get("guarantees", {}).get(name, Outcome.UNKNOWN))
        found.append(verdict)
    return str(worst(found))


def _disagrees(judge: dict[str, Any], requirements: tuple[str, ...]) -> bool:
    """Whether the judge disagrees on a requirement, or on the identity of the log."""
    return any(d["guarantee"] in ("", *requirements) for d in judge.get("disagreements", []))


def code_of(outcomes: set[str], asked: bool = True) -> int:
    """The exit code: 0 if every run holds, 1 if something is violated, 3 if something is not known.

    asked: False if logs were to be checked against the proved steps of authority, and none could
    be.
    """
    if outcomes & set(BAD):
        return 1
    return 0 if asked and outcomes == {str(Outcome.HOLDS)} else 3
