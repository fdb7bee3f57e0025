"""A whole trace at once, operator by operator: the operators' kernels, called step by step as for single samples.

Times (n) increase. The result for an operator is an array (2, n) of int64: for each sample the verdict, 0 false, 1
unknown, 2 true, and the sample at which it is decided, n for one that is not decided when the trace ends. CPython
runs these functions directly; `core.readings.machine.compiled.machine` compiles the same text.
"""

from math import isfinite

import numpy as np

from cratous.core.requirements import since
from cratous.core.requirements.until import Times, until_decided, until_times
from cratous.core.requirements.verdict import both, either, negated, reaches

NEVER = -(2**62)


def reached(left: np.ndarray, right: np.ndarray, verdict: np.ndarray) -> None:
    """Fill `verdict` (n) with whether left is at least right at each sample.

    left, right: (n), or (1) for a number; NaN and infinite values are unknown.
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


def joined(phi: np.ndarray, psi: np.ndarray, is_and: bool, found: np.ndarray) -> None:
    """Fill `found` (2, n) with phi and psi, or phi or psi: decided by one side alone if that suffices."""
    alone, last = 0 if is_and else 2, 0
    for k in range(found.shape[1]):
        at = max(phi[1, k], psi[1, k])
        if phi[0, k] == alone:
            at = min(at, phi[1, k])
        if psi[0, k] == alone:
            at = min(at, psi[1, k])
        # verdicts come in the order of the samples
        last = max(last, at)
        found[1, k] = last
        if phi[1, k] > last:
            found[0, k] = psi[0, k]
        elif psi[1, k] > last:
            found[0, k] = phi[0, k]
        elif is_and:
            found[0, k] = both(phi[0, k], psi[0, k])
        else:
            found[0, k] = either(phi[0, k], psi[0, k])


def until_of(
    times: np.ndarray, phi: np.ndarray, psi: np.ndarray, low: int, high: int, found: np.ndarray
) -> None:
    """Fill `found` (2, n) with phi until psi between low and high ahead."""
    n, head, last = len(times), 0, 0
    so_far = Times(NEVER, NEVER)
    for k in range(n):
        found[0, k], found[1, k] = 1, n
    for k in range(n):
        # psi may decide before phi is known (`requirements_until_is_decided_ahead_of_phi`)
        first = max(psi[1, k], last)
        last = max(max(phi[1, k], psi[1, k]), last)
        if first < last and first < n:
            while head <= k:
                word = until_decided(so_far, times[k], 2, psi[0, k], times[head], low, high)
                if word == 3:
                    break
                found[0, head], found[1, head] = word, first
                head += 1
        if last >= n:
            break
        while head <= k:
            word = until_decided(so_far, times[k], phi[0, k], psi[0, k], times[head], low, high)
            if word == 3:
                break
            found[0, head], found[1, head] = word, last
            head += 1
        so_far = until_times(so_far, times[k], phi[0, k], psi[0, k])


def since_of(
    times: np.ndarray, phi: np.ndarray, psi: np.ndarray, low: int, high: int, found: np.ndarray
) -> None:
    """Fill `found` (2, n) with phi since psi between low and high ago."""
    n, young, last = len(times), 0, 0
    latest, broken = since.Found(NEVER - 1, NEVER - 1), since.Broken(NEVER, NEVER)
    for k in range(n):
        last = max(max(phi[1, k], psi[1, k]), last)
        found[1, k] = last
        if last >= n:
            found[0, k], found[1, k] = 1, n
            continue
        while young <= k and since.is_due(times[young], times[k], low):
            latest = since.since_found(latest, times[young], psi[0, young])
            young += 1
        broken = since.since_broken(broken, times[k], phi[0, k])
        found[0, k] = since.since_decided(latest, broken, times[k], high)
