"""Objects in JSON whose fields stand in the order of the wire are read as those in any other order are."""

from __future__ import annotations

from typing import Any

import pytest

from cratous.bridge.lmcp import jsonform, types
from cratous.bridge.lmcp.jsonform import from_dict, to_dict
from cratous.spec.errors import BadInput

NAMES = (
    "CMASI/AirVehicleState", "CMASI/Wedge", "CMASI/CameraState", "CMASI/MissionCommand", "CRATOUS/TruthState",
    "CRATOUS/Heartbeat", "UXTASK/TaskPlanOptions", "ROUTE/RoutePlanRequest", "CMASI/EntityConfiguration",
)  # fmt: skip
VALUES: tuple[Any, ...] = (
    None, True, 0, 1, -1, 2**40, 2**70, 0.5, -0.0, 1e39, "", "text", "NaN", "Up", [], [1], ["x"], [None], {},
    {"$type": "CMASI/Location3D"}, {"$type": "CMASI/Nothing"}, [{"$type": "CMASI/Location3D"}],
    [{"$type": "CMASI/Location3D", "Latitude": "here"}], [{"$type": "CMASI/KeyValuePair"}, 3],
)  # fmt: skip


def said(data: dict[str, Any]) -> Any:
    try:
        return from_dict(data)
    except BadInput as no:
        return no.data()


def otherwise(data: dict[str, Any]) -> dict[str, Any]:
    """The same with its fields from the last to the first."""
    return {"$type": data["$type"], **dict(reversed(list(data.items())[1:]))}


@pytest.mark.parametrize("name", NAMES)
def test_every_value_of_every_field_is_taken_or_refused_alike(name: str) -> None:
    whole = to_dict(types[name]())
    assert tuple(whole) == jsonform._reader(name)[1]
    assert said(whole) == said(otherwise(whole)) == types[name]()
    taken = 0
    for field in list(whole)[1:]:
        for value in VALUES:
            data = {**whole, field: value}
            one, other = said(data), said(otherwise(data))
            assert repr(one) == repr(other), (field, value)
            assert type(one) is type(other)
            if not isinstance(one, dict):
                taken += 1
                kinds = [type(getattr(found, field)) for found in (one, other)]
                assert kinds[0] is kinds[1], (field, value)
    assert taken
