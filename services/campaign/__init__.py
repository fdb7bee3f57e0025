"""Many runs of missions on one engine: named by what decides them, stored once, counted truly.

Nothing here knows how a mission is flown: a run is plain data, and the function that flies one is named
by the command that starts a campaign. Read in this order: `definition.py`, `runs.py`, `flier.py`,
`engine.py`, `store.py`, `campaign.py`, `summary.py`, `search.py`.
"""
