"""Properties of several components together: steps of different programs, connected by messages."""
