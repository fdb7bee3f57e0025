"""Roads of OpenStreetMap for vehicles that drive: the map, ways along it, and the service that answers."""
