"""The span of an uncertain altitude lies within [0, T], or holds no instant."""

from cratous.core.daa.uncertainty import layer_above, layer_span
from cratous.proofs.claim import Claim
from cratous.proofs.methods.uncertainty import layer_lies_within


def claim(c: Claim) -> None:
    layer_lies_within(
        c,
        layer_span,
        "sz vz ez ew zthr tcoa vmod end",
        (layer_above, "daa_uncertain_layer_above_lies_within"),
        "low high slow fast zthr tcoa vmod end",
    )
