"""What detect and avoid means, its parameters, and the files they come in."""
