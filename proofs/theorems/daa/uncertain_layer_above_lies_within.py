"""The span of an altitude known to be on one side lies within [0, T], or holds no instant."""

from cratous.core.daa.uncertainty import layer_above
from cratous.core.well_clear.interval import vertical_interval
from cratous.proofs.claim import Claim
from cratous.proofs.methods.uncertainty import layer_lies_within


def claim(c: Claim) -> None:
    layer_lies_within(
        c,
        layer_above,
        "low high slow fast zthr tcoa vmod end",
        (vertical_interval, "well_clear_vertical_interval_lies_within"),
        "sz vz zthr tcoa vmod begin end",
    )
