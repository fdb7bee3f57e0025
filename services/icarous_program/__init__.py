"""One vehicle's ICAROUS as a separate program, at its end of the CRATOUS bridge."""
