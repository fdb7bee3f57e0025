"""Which trajectories are permitted: clear of every intruder's tube and of every zone until they expire."""
