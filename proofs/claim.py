"""What a file of a theorem imports: `Claim`. How it works is in `cratous.proofs.engine`."""

from cratous.proofs.engine.claim import Claim

__all__ = ["Claim"]
