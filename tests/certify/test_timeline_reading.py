"""TruthStates are read by a short way where they are written as usual; it gives what JSON gives."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import lmcp
from cratous.services.certify.timeline import TRUTH, FlightReader
from cratous.services.logs.log import Row
from cratous.spec.errors import BadInput

TOPIC = "cratous.TruthState"
NUMBERS = st.floats(-1e7, 1e7)


@st.composite
def truths(draw: st.DrawFn) -> str:
    """The text of a TruthState as a log has it."""
    body = lmcp.types["TruthState"]()
    body.VehicleID, body.Time = draw(st.integers(0, 3)), draw(st.integers(0, 5000))
    for name in ("North", "East", "Altitude", "VelocityNorth", "VelocityEast", "VelocityDown"):
        setattr(body, name, draw(NUMBERS))
    body.Heading, body.Cooperative = draw(st.floats(0, 360)), draw(st.booleans())
    return str(lmcp.to_json(body))


def _read(texts: list[str]) -> tuple[str, str]:
    reader = FlightReader([1, 2])
    for number, text in enumerate(texts):
        reader.add(Row(number, 0, "simulation", TOPIC, text))
    flight = reader.finish()
    return json.dumps(flight.tracks), json.dumps(flight.counts)


@given(st.lists(truths(), max_size=12))
def test_both_ways_give_the_same_to_the_last_digit(texts: list[str]) -> None:
    longer = [text.replace('{"$type"', '{ "$type"', 1) for text in texts]
    assert not any(TRUTH.fullmatch(text) for text in longer)
    assert _read(texts) == _read(longer)


def test_a_text_as_it_is_written_takes_the_short_way() -> None:
    body = lmcp.types["TruthState"]()
    body.VehicleID, body.Time, body.North, body.VelocityDown = 7, 250, -12.345678901234567, -0.0
    assert TRUTH.fullmatch(lmcp.to_json(body))


@pytest.mark.parametrize(
    ("now", "then"),
    [('"Time":1', '"Time":01'), ('"North":2.0', '"North":2'), ('"North":2.0', '"North":NaN'),
     ('"North":2.0', '"North":٢.0'), ("false}", 'false,"North":9.0}'), ("false}", "false} ")],
)  # fmt: skip
def test_a_text_that_is_written_otherwise_is_left_to_json(now: str, then: str) -> None:
    body = lmcp.types["TruthState"]()
    body.Time, body.North, body.Cooperative = 1, 2.0, False
    text = lmcp.to_json(body)
    assert TRUTH.fullmatch(text)
    assert now in text
    assert not TRUTH.fullmatch(text.replace(now, then))


def test_a_field_that_is_missing_is_told() -> None:
    text = '{"$type":"CRATOUS/AuthorityChange"}'
    with pytest.raises(BadInput, match="a field is missing") as raised:
        FlightReader([1]).add(Row(7, 0, "vehicle/1", "cratous.AuthorityChange", text))
    assert raised.value.where == "message 7 (cratous.AuthorityChange)"
