"""What the planning services require of each other, for one request, task or path at a time."""
