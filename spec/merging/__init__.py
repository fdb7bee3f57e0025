"""Definitions for merging at a fix: slots, votes for a leader, slots granted by members, and stages of a vehicle."""
