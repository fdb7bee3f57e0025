"""OpenStreetMap roads for ground vehicles: the map, routes along it, and the planning service."""
