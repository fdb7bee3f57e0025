"""LMCP objects: classes made from models held as data, and their XML, JSON and binary forms.

    from cratous.bridge import lmcp
    state = lmcp.new("AirVehicleState", ID=400, Mode="Waypoint")
    lmcp.full_names(state)   # ('afrl.cmasi.AirVehicleState', 'afrl.cmasi.EntityState')
    lmcp.types["afrl.cmasi.AirVehicleState"], lmcp.enums["AltitudeType"].AGL
    lmcp.to_json(state), lmcp.xml.read_file(path), lmcp.binary.pack(state)

A type is identified by its full name (`afrl.cmasi.Task`), by series (`CMASI/Task`) or, where that is
unique, by its short name (`Task`); a short name in several series means the first of them in
`model.SERIES`. Models load on first use, one series at a time.
"""

from __future__ import annotations

from cratous.bridge.lmcp import binary, mdm, xml
from cratous.bridge.lmcp.jsonform import from_dict, from_json, to_data, to_dict, to_json
from cratous.bridge.lmcp.objects import LmcpObject, enums, full_names, new, types

__all__ = [
    "LmcpObject",
    "binary",
    "enums",
    "from_dict",
    "from_json",
    "full_names",
    "mdm",
    "new",
    "to_data",
    "to_dict",
    "to_json",
    "types",
    "xml",
]
