"""What the planning services owe each other, one request, task or path at a time."""
