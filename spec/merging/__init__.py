"""What must be true where vehicles merge at a fix: of their slots, of votes, and of what members grant."""
