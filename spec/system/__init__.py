"""What must hold of several parts together: steps of different programs, joined by messages."""
