"""Missions from the files of others: flight plans, fences, traffic, maps and parameters of ICAROUS."""
