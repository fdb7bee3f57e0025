"""What UxAS's executive decides about chains of tasks in flight."""
