"""Ways over places and in time: past zones, walls, and traffic that moves."""
