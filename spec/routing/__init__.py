"""Definitions for flying a route: speeds in the wind."""
