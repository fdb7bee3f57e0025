"""The prover tried on itself: packages that it must refuse, and their near misses that it must accept.

`cratous prove --self-test` runs it; the cases are data, in `cases/<kind>/<name>.case`.
"""
