"""Mission data shared by planning, flight and monitor: frames, zones, wind, times, cameras."""
