"""What a theorem file imports: `Claim`. See `cratous.proofs.engine` for its implementation."""

from cratous.proofs.engine.claim import Claim

__all__ = ["Claim"]
