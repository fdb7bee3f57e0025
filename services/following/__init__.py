"""Tasks that keep to what moves: where their vehicles fly, what they look at, and when they are over."""
