"""Merging at a fix: arrival slots, votes for a leader, and slots that members grant."""
