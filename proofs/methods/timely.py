"""Theorems on verdicts about time that speak of every instant: one of them decides."""

from __future__ import annotations

from typing import Any

from cratous.proofs.claim import Claim


def holds_at_every_instant(
    c: Claim, kernel: Any, meant: Any, asked: tuple[Any, ...], witness: Any, texts: tuple[str, str]
) -> None:
    """Show that a kernel says yes exactly where the definition does at any instant `t`.

    witness: the instant at which the definition says no where the kernel does; texts: of both ways.
    """
    said = c.use(kernel, *asked)
    at_any = c.define(meant, c.integer("t"), *asked)
    c.show(c.implies(said, at_any), texts[0])
    then = c.define(meant, witness, *asked)
    c.show(c.implies(c.negation(said), c.negation(then)), texts[1])
