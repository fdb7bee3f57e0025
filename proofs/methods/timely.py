"""Theorems on verdicts that speak of every instant, where one instant decides."""

from __future__ import annotations

from typing import Any

from cratous.proofs.claim import Claim


def holds_at_every_instant(
    c: Claim, kernel: Any, meant: Any, asked: tuple[Any, ...], witness: Any, texts: tuple[str, str]
) -> None:
    """Show that a kernel says yes exactly where the definition holds at every instant `t`.

    witness: an instant at which the definition says no if the kernel does; texts: of the two directions.
    """
    said = c.use(kernel, *asked)
    at_any = c.define(meant, c.integer("t"), *asked)
    c.show(c.implies(said, at_any), texts[0])
    then = c.define(meant, witness, *asked)
    c.show(c.implies(c.negation(said), c.negation(then)), texts[1])
