"""Whether what a theorem shows is the same wherever it serves as a lemma.

Where a caller of the lemma does not look into its kernel, the lemma meets none of the kernel's own
calls (`Claim.calls` is empty there). It may cite lemmas about each of them, but a goal that is made
of them would then be another goal than the one that was proved, without a word.
"""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.hidden_calls import same
from cratous.proofs.engine.theorem_files import load_claim, load_lemma


def hangs_on_calls(name: str, folder: Path) -> bool:
    """Does the theorem show something else, or nothing, where it meets no calls?"""
    statement = load_claim(name, folder)[0]
    lemma = functools.cache(lambda other: load_lemma(other, folder))

    def read(**how: Any) -> Claim:
        claim = Claim(load=lemma, **how)
        statement(claim)
        return claim

    plain = read()
    if not plain.asked:
        return False
    try:
        # what is not looked into has one name in both
        without = read(hidden=True, stubs=dict(plain.stubs))
    except (ValueError, TypeError, IndexError):
        return True  # it takes them for granted
    return not same(plain, without)
