"""A whole trace at once, operator by operator: the kernels of the operators, step by step as sample by sample.

Verdicts are arrays (n) of int64, 0 false, 1 unknown, 2 true; `known` (n) is at which sample each is decided, n for one
that is not decided when the trace ends; times (n) rise. CPython runs these functions as they stand;
`core.readings.machine.compiled.machine` compiles the same text.
"""

from math import isfinite

import numpy as np

from cratous.core.requirements.since import (
    Broken,
    Found,
    is_due,
    since_broken,
    since_decided,
    since_found,
)
from cratous.core.requirements.until import Times, until_decided, until_times
from cratous.core.requirements.verdict import both, either, negated, reaches

NEVER = -(2**62)


def reached(left: np.ndarray, right: np.ndarray, verdict: np.ndarray) -> None:
    """Fill `verdict` (n) with whether left is at least right at each sample.

    left, right: (n), or (1) for a number; what is no number or infinite is unknown.
    """
    for k in range(len(verdict)):
        a, b = left[k if len(left) > 1 else 0], right[k if len(right) > 1 else 0]
        if not (isfinite(a) and isfinite(b)):
            verdict[k] = 1
        elif reaches(a, b):
            verdict[k] = 2
        else:
            verdict[k] = 0


def not_of(phi: np.ndarray, verdict: np.ndarray) -> None:
    """Fill `verdict` (n) with not phi."""
    for k in range(len(verdict)):
        verdict[k] = negated(phi[k])


def joined(
    phi: np.ndarray, known_phi: np.ndarray, psi: np.ndarray, known_psi: np.ndarray, is_and: bool,
    verdict: np.ndarray, known: np.ndarray,
) -> None:  # fmt: skip
    """Fill `verdict` and `known` (n) with phi and psi, or phi or psi: decided by one side alone where that suffices."""
    alone, last = 0 if is_and else 2, 0
    for k in range(len(verdict)):
        at = max(known_phi[k], known_psi[k])
        if phi[k] == alone:
            at = min(at, known_phi[k])
        if psi[k] == alone:
            at = min(at, known_psi[k])
        # verdicts come in the order of the samples
        last = max(last, at)
        known[k] = last
        if known_phi[k] > last:
            verdict[k] = psi[k]
        elif known_psi[k] > last:
            verdict[k] = phi[k]
        elif is_and:
            verdict[k] = both(phi[k], psi[k])
        else:
            verdict[k] = either(phi[k], psi[k])


def until_of(
    times: np.ndarray, phi: np.ndarray, known_phi: np.ndarray, psi: np.ndarray,
    known_psi: np.ndarray, low: int, high: int, verdict: np.ndarray, known: np.ndarray,
) -> None:  # fmt: skip
    """Fill `verdict` and `known` (n) with phi until psi between low and high ahead."""
    n, head, last = len(times), 0, 0
    so_far = Times(NEVER, NEVER)
    for k in range(n):
        verdict[k], known[k] = 1, n
    for k in range(n):
        # psi may decide before phi is known (`requirements_until_is_decided_ahead_of_phi`)
        first = max(known_psi[k], last)
        last = max(max(known_phi[k], known_psi[k]), last)
        if first < last and first < n:
            while head <= k:
                found = until_decided(so_far, times[k], 2, psi[k], times[head], low, high)
                if found == 3:
                    break
                verdict[head], known[head] = found, first
                head += 1
        if last >= n:
            break
        while head <= k:
            found = until_decided(so_far, times[k], phi[k], psi[k], times[head], low, high)
            if found == 3:
                break
            verdict[head], known[head] = found, last
            head += 1
        so_far = until_times(so_far, times[k], phi[k], psi[k])


def since_of(
    times: np.ndarray, phi: np.ndarray, known_phi: np.ndarray, psi: np.ndarray,
    known_psi: np.ndarray, low: int, high: int, verdict: np.ndarray, known: np.ndarray,
) -> None:  # fmt: skip
    """Fill `verdict` and `known` (n) with phi since psi between low and high ago."""
    n, young, last = len(times), 0, 0
    found, broken = Found(NEVER - 1, NEVER - 1), Broken(NEVER, NEVER)
    for k in range(n):
        last = max(max(known_phi[k], known_psi[k]), last)
        known[k] = last
        if last >= n:
            verdict[k], known[k] = 1, n
            continue
        while young <= k and is_due(times[young], times[k], low):
            found = since_found(found, times[young], psi[young])
            young += 1
        broken = since_broken(broken, times[k], phi[k])
        verdict[k] = since_decided(found, broken, times[k], high)
