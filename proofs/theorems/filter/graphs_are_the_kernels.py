"""The graph from which the filter, the expansions and the integers of a kernel are generated
computes, over the real numbers, what the kernel computes, for every kernel with real arguments."""

from cratous.core.readings.exact.certainty import surely_above
from cratous.proofs.claim import Claim
from cratous.proofs.methods.rounding import filters, graph_is_kernel


def claim(c: Claim) -> None:
    c.use(surely_above, c.real("value"), c.real("bound"))
    for name, (kernel, _) in filters().items():
        graph_is_kernel(c, name, kernel)
