"""Detect and avoid on the bus: the DAIDALUS message series, detection, and conflict resolution."""
