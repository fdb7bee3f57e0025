"""Merging at a fix: arrival slots, votes for a leader, slots granted by members, and stages of a vehicle."""
