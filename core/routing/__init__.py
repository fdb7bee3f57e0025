"""Routes that can be flown: turns, visibility around zones, laps, wind."""
