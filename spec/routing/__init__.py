"""What flying a route means: speeds in the wind."""
