"""The decision with tep on invariants agrees with the definition whenever the invariants are those
of a relative state."""

from cratous.core.well_clear import tep_decision
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import decision_is_the_definition
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    decision_is_the_definition(c, tep_decision, well_clear.horizontal_violation_tep)
