"""Every proof is also run: kernels, definitions and goals on numbers, independently of the solver.

`readings` compares the readings of a function with each other, `statement` runs what a theorem states. A difference
makes a theorem not proved, whatever the solver answered.
"""
