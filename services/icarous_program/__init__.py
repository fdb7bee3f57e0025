"""ICAROUS of one vehicle as a program of its own, at its end of the CRATOUS bridge."""
