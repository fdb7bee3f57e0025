"""The flight: aircraft, autopilots, gates, the executive and both ends of the bridge."""
