"""Texts that generated functions write are those of JSON's own writer, which gets all other objects."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import lmcp
from cratous.bridge.lmcp.json_text import plain_text
from cratous.bridge.lmcp.jsonform import to_dict, to_json

TRUTH: Any = lmcp.types["cratous.TruthState"]
STATE: Any = lmcp.types["afrl.cmasi.AirVehicleState"]
PAIR: Any = lmcp.types["afrl.cmasi.KeyValuePair"]
MODE = lmcp.enums["afrl.cmasi.NavigationMode"]
LARGEST = 2**63 - 1


def by_json(body: Any) -> str:
    """As JSON's own writer has it, for finite values of their fields' types."""
    return json.dumps(to_dict(body), separators=(",", ":"), ensure_ascii=False, allow_nan=False)


@pytest.mark.parametrize("name", sorted(lmcp.types))
def test_each_type_is_written_as_by_json(name: str) -> None:
    body = lmcp.types[name]()
    assert plain_text(body) == by_json(body)


@given(
    st.floats(width=32, allow_nan=False, allow_infinity=False),
    st.text(),
    st.integers(-LARGEST, LARGEST),
    st.sampled_from([*MODE]),
)
def test_values_of_their_types(number: float, text: str, count: int, mode: Any) -> None:
    info = [PAIR(Key=text, Value="\\\"{}'\n\x7f\ud800")]
    body = STATE(ID=count, u=number, Mode=mode, AssociatedTasks=[count, 0], Info=info)
    assert plain_text(body) == by_json(body)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (float("nan"), '"NaN"'),
        (float("-inf"), '"-Infinity"'),
        (3, "3.0"),
        (np.float64(2.5), "2.5"),
    ],
)
def test_other_values_are_left_to_json(value: Any, text: str) -> None:
    body = TRUTH(VehicleID=3)
    object.__setattr__(body, "North", value)  # past the checks
    assert plain_text(body) is None
    assert f'"North":{text},' in to_json(body)
