"""Writes a mission in other tools' formats: AMASE scenario, UxAS configuration and messages,
GeoJSON, KML, ICAROUS files.
"""
