"""Tasks relative to a moving entity: where their vehicles fly, what they look at, and when they are complete."""
