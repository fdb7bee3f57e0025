"""What a requirement over time means."""
