"""A self-test of the prover: packages that it must refuse, and similar ones that it must accept.

`cratous prove --self-test` runs it; the cases are data, in `cases/<kind>/<name>.case`.
"""
