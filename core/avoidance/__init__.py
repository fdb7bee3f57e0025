"""Avoidance in flight: trajectories that can be flown, prediction, and resolution."""
