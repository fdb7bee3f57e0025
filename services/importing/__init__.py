"""Missions from other tools' files: flight plans, fences, traffic, maps and parameters of ICAROUS."""
