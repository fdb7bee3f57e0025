"""A mission in the formats of others: AMASE scenario, UxAS configuration and messages, GeoJSON, KML, files of ICAROUS."""
