"""Campaigns: many runs of missions, identified by their inputs, stored once, and counted.

Nothing here knows how a mission is flown: a run is plain data, and the command that starts a
campaign names the function that flies one. Reading order: `definition.py`, `runs.py`, `flight_worker.py`,
`engine.py`, `store.py`, `campaign.py`, `summary.py`, `search.py`.
"""
