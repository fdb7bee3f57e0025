"""What planning, flight and monitor share of a mission: frames, zones, wind, times, cameras."""
