"""Flyable routes: turns, visibility around zones, laps, wind."""
