"""The textbook's bounded response, and recovery that lasts, on random samples, held against a scan of the list."""

from __future__ import annotations

import random

import pytest

from cratous.services.requirements import c2po
from cratous.services.requirements.evaluation import Evaluation

HEAD = "INPUT\n  request, response: float;\nFTSPEC\n"
SAMPLES = 1500
Trace = list[dict[str, float | None]]


def trace(seed: int) -> Trace:
    """Requests and responses, now seldom, now often, and each for a while."""
    draw, found, row = (
        random.Random(seed),
        list[dict[str, float | None]](),
        {"request": 0.0, "response": 0.0},
    )
    often = {name: draw.choice([0.002, 0.02, 0.2]) for name in row}
    for _ in range(SAMPLES):
        row = {n: 1.0 - v if draw.random() < often[n] else v for n, v in row.items()}
        found.append(dict(row))
    return found


def verdicts(text: str, samples: Trace) -> dict[int, tuple[int, int]]:
    """By sample: the verdict, and at which sample it was given."""
    (one,) = c2po.read(f"{HEAD}  it: {text};\n", "textbook").requirements
    assert not isinstance(one.formula, Exception)
    evaluation, found = Evaluation(one.formula), {}
    for at, row in enumerate(samples):
        for sample, verdict in evaluation.sample(at, row):
            assert sample not in found
            found[sample] = verdict, at
    return found


@pytest.mark.parametrize("bound", [1, 7, 10, 60, 100, 1000])
def test_bounded_response_is_as_a_scan_of_the_list_says(bound: int) -> None:
    for seed in range(8):
        samples = trace(seed)
        found = verdicts(f"(request >= 0.5) -> F[0,{bound}] (response >= 0.5)", samples)
        told = 0
        for k in range(SAMPLES - bound):
            answers = [j for j in range(k, k + bound + 1) if samples[j]["response"]]
            if not samples[k]["request"]:
                right, known = 2, k
            elif answers:
                right, known = 2, answers[0]
            else:
                right, known = 0, k + bound
            told = max(told, known)  # in the order of samples, each as soon as it is known
            assert found[k] == (right, told)


@pytest.mark.parametrize(("within", "lasting"), [(5, 3), (20, 40), (100, 10)])
def test_recovery_that_lasts_is_as_a_scan_of_the_list_says(within: int, lasting: int) -> None:
    for seed in range(8):
        samples = trace(seed)
        inside = [bool(row["response"]) for row in samples]
        text = f"(request >= 0.5) -> F[0,{within}] G[0,{lasting}] (response >= 0.5)"
        found = verdicts(text, samples)
        for k in range(SAMPLES - within - lasting):
            starts = range(k, k + within + 1)
            recovers = any(all(inside[j : j + lasting + 1]) for j in starts)
            assert found[k][0] == (2 if not samples[k]["request"] or recovers else 0)
