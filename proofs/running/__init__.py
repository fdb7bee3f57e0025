"""Every proof is run: kernels, definitions and goals on numbers, beside what the solver said of them.

`readings` compares the readings of a function with each other, `statement` runs what a theorem states.
A difference makes a theorem not proved, whatever the solver says.
"""
