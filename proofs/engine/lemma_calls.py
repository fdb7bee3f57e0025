"""Whether a theorem shows the same wherever it serves as a lemma.

Where a user of the lemma does not look into its kernel, the lemma meets none of the kernel's own calls (`Claim.calls`
is empty there). A theorem may use lemmas about each of those calls, but a goal made of the calls themselves would
then silently differ from the one that was proved.
"""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.hidden_calls import same
from cratous.proofs.engine.theorem_files import load_claim, load_lemma


def hangs_on_calls(name: str, folder: Path) -> bool:
    """Whether the theorem shows something else, or nothing, where it meets no calls."""
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
        # an opaque function has one name in both
        without = read(hidden=True, stubs=dict(plain.stubs))
    except (ValueError, TypeError, IndexError):
        return True  # it fails without calls
    return not same(plain, without)
