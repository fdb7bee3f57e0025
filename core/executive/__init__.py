"""Decisions of UxAS's executive on chains of tasks in flight."""
