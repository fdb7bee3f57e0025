"""Whether a loss of well clear could have been avoided."""
