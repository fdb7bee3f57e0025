"""Ways past zones and moving traffic, searched over position and time."""
