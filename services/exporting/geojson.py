"""A mission as GeoJSON (RFC 7946).

Positions are longitude and latitude only: a third number would be a height above the ellipsoid.
Altitudes are properties, above mean sea level.
"""

from __future__ import annotations

import json
from typing import Any

from cratous.services.exporting.shapes import AREA, POINT, Shape, shapes
from cratous.spec.mission import Mission
from cratous.spec.mission.plan import Plan


def geojson_text(mission: Mission, plan: Plan | None = None) -> str:
    """A FeatureCollection with a feature for each vehicle, task, zone and planned route."""
    features = [_feature(shape) for shape in shapes(mission, plan)]
    data = {"type": "FeatureCollection", "name": mission.name, "features": features}
    return json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _feature(shape: Shape) -> dict[str, Any]:
    # 1e-9 degrees are 0.1 mm
    places: Any = [[round(lon, 9), round(lat, 9)] for lon, lat, _ in shape.places]
    inside = places[0] if shape.form == POINT else [places] if shape.form == AREA else places
    name = f"{shape.properties['kind']}-{shape.properties['id']}"
    return {
        "type": "Feature",
        "id": name,
        "geometry": {"type": shape.form, "coordinates": inside},
        "properties": shape.properties,
    }
