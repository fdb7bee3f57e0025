"""Texts that are read by a pattern give what JSON's own reader gives, and all others are left to it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import lmcp
from cratous.bridge.lmcp.fast_json import plain_object
from cratous.bridge.lmcp.jsonform import from_dict, from_json, to_json
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import json_of

TRUTH: Any = lmcp.types["cratous.TruthState"]
STATE: Any = lmcp.types["afrl.cmasi.AirVehicleState"]
BEAT: Any = lmcp.types["cratous.Heartbeat"]
reals = st.floats(allow_nan=False, allow_infinity=False)
TEXT = to_json(TRUTH(VehicleID=3, Time=250, North=-1.5, East=2e-7, Heading=90.0))


def by_json(text: str) -> Any:
    return from_dict(json_of(text, ""), "")


def outcome(read: Callable[[str], Any], text: str) -> str:
    """What comes of reading a text: the object as text, or what is wrong with it."""
    try:
        return to_json(read(text))
    except BadInput as error:
        return f"refused: {error}"


@given(st.integers(-(2**63), 2**63 - 1), st.lists(reals, min_size=7, max_size=7), st.booleans())
def test_it_gives_what_json_gives(number: int, values: list[float], flag: bool) -> None:
    names = (
        "North",
        "East",
        "Altitude",
        "VelocityNorth",
        "VelocityEast",
        "VelocityDown",
        "Heading",
    )
    made = TRUTH(VehicleID=number, Cooperative=flag, **dict(zip(names, values, strict=True)))
    text = to_json(made)
    found = plain_object(text)
    assert found is None or to_json(found) == text
    assert to_json(from_json(text)) == to_json(by_json(text)) == text


@given(st.data())
def test_a_changed_text_is_read_as_before(data: st.DataObject) -> None:
    text = data.draw(
        st.sampled_from([TEXT, to_json(BEAT(VehicleID=1, Sequence=7)), to_json(STATE(ID=4))])
    )
    at = data.draw(st.integers(0, len(text) - 1))
    piece = data.draw(
        st.sampled_from(
            ["", "-", "0", "9", "e5", "E-3", ".", ",", '"', "\\", " ", "\n", "{", "null", "\u0661"]
        )
    )
    text = text[:at] + piece + text[at + data.draw(st.integers(0, 2)) :]
    assert outcome(from_json, text) == outcome(by_json, text)
    if plain_object(text) is not None:
        assert outcome(plain_object, text) == outcome(by_json, text)


def test_what_most_of_a_log_is_fits_a_pattern() -> None:
    for made in (
        TRUTH(VehicleID=1, North=1.25, East=1e-7),
        BEAT(VehicleID=1, Sequence=9),
        STATE(
            ID=1, Location=lmcp.types["afrl.cmasi.Location3D"](Latitude=1.5), AssociatedTasks=[3, 4]
        ),
    ):
        text = to_json(made)
        found = plain_object(text)
        assert found == made
        kinds = [type(x) for x in type(made).values_of(found)]
        assert kinds == [type(x) for x in type(made).values_of(by_json(text))]


@pytest.mark.parametrize(
    "text",
    ["", "{}", '{"$type":"', '{"$type":"CRATOUS/NoSuch"}', '{"$type":"nothing"}', TEXT + " "],
)
def test_anything_else_is_left(text: str) -> None:
    assert plain_object(text) is None
