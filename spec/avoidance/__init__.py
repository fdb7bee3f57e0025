"""What avoidance in flight takes for granted: the way ahead, and who flies straight on."""
