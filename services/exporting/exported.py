"""Writes a mission in a format, and lists what the format cannot represent."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from cratous.core.files.whole_file import write_atomically
from cratous.services.exporting import icarous
from cratous.services.exporting.amase import scenario_text
from cratous.services.exporting.differences import differences
from cratous.services.exporting.geojson import geojson_text
from cratous.services.exporting.kml import kml_text
from cratous.services.exporting.messages import messages_of
from cratous.services.exporting.shapes import unsaid
from cratous.services.exporting.uxas import (
    CONFIGURATION,
    MESSAGES,
    configuration_text,
    messages_text,
)
from cratous.services.loading import count_requests, load
from cratous.services.loading.document import Document, read_document
from cratous.services.mission.moving_zones import refuse_moving
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission
from cratous.spec.mission.plan import Plan

AMASE, UXAS, GEOJSON, KML = FORMATS = ("amase", "uxas", "geojson", "kml")
MAPS = {GEOJSON: geojson_text, KML: kml_text}
OF_ICAROUS = (icarous.QGC, icarous.GEOFENCE)
"""Formats for one aspect of a mission each: the route of a vehicle, the zones."""
ALL = (*FORMATS, *OF_ICAROUS)
ROUTED = (*MAPS, icarous.QGC)
"""Formats that can contain the routes of a plan."""
ENDINGS = {AMASE: "xml", GEOJSON: "geojson", KML: "kml"}

SECTIONS = ("variation", "expect")
"""Sections of a mission file that are not part of the mission itself."""


class Exported(NamedTuple):
    """files: texts by name, a single one or those of a UxAS folder; unsaid: what they do not
    represent, in words.
    """

    files: dict[str, str]
    unsaid: tuple[str, ...]


def exported(
    mission: Mission,
    form: str,
    plan: Plan | None = None,
    folder: str | None = None,
    vehicle: int | None = None,
) -> Exported:
    """The mission in one of FORMATS or OF_ICAROUS; plan: its routes, only for map formats and
    flight plans; folder: name of a UxAS folder, which is the name of its mission; vehicle: of a
    flight plan. Raises BadInput for what cannot be written at all.

    Exports for AMASE and UxAS are read again; differences show what was not represented.
    """
    refuse_moving(mission, f"the format {form} cannot represent")
    if form in MAPS:
        text = MAPS[form](mission, plan)
        return Exported({f"{mission.name}.{ENDINGS[form]}": text}, tuple(unsaid(mission)))
    if form in OF_ICAROUS:
        if form == icarous.QGC:
            name, text = (
                f"{mission.name}.waypoints",
                icarous.flight_plan_text(mission, vehicle, plan),
            )
        else:
            name, text = f"{mission.name}.fences.xml", icarous.geofence_text(mission)
        return Exported({name: text}, tuple(icarous.unsaid_of(mission, form)))
    try:
        told = messages_of(mission)
    except BadInput as error:
        error.where = error.where or mission.source
        raise
    if form == AMASE:
        text = scenario_text(mission, told, mission.simulation.limit_ms / 1000, tasks=True)
        files = {f"{mission.name}.xml": text}
    else:
        settings = configuration_text(mission, mission.instances)
        files = {CONFIGURATION: settings, MESSAGES: messages_text(told)}
    with TemporaryDirectory(prefix="cratous-export-") as scratch:
        place = Path(scratch) / (folder or mission.name)
        place.mkdir()
        for name, text in files.items():
            write_atomically(place / name, text)
        again = load(place if form == UXAS else place / next(iter(files)))
    return Exported(files, tuple(one.text for one in differences(mission, again)))


def beside(path: Path, number: int) -> list[str]:
    """Contents of a file besides the exported mission, in words; number: of the request."""
    if path.is_dir() and (path / "mission.yaml").is_file():
        path = path / "mission.yaml"
    if path.suffix.lower() in (".yaml", ".yml"):
        return beside_document(read_document(path))
    count = count_requests(path)
    return [f"requests: this is request {number} of {count}"] if count > 1 else []


def beside_document(document: Document) -> list[str]:
    """The same for a parsed mission file."""
    return [f"{name}: a section of the mission file" for name in SECTIONS if name in document.data]
