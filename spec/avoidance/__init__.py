"""Definitions used by avoidance in flight: the path ahead, straight flight, landing."""
