"""The decision with tcpa on invariants agrees with the definition whenever the invariants are those
of a relative state."""

from cratous.core.well_clear import tcpa_decision
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import decision_is_the_definition
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    decision_is_the_definition(c, tcpa_decision, well_clear.horizontal_violation_tcpa)
