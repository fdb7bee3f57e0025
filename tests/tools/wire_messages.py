"""Messages of the text protocol at random, each with values that its fields may have."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from cratous.bridge import text_protocol as tp
from cratous.bridge.text_protocol.layouts import LAYOUTS, FieldLayout, Kind, Layout

OWN_POSITION = tp.OwnPosition(
    12.5, 45.301234, -120.998765, 700.25, 700.25, 21.213203, -5.5, 1.25, vehicle_id=1
)
ATTITUDE = tp.Attitude(-12.5, 3.25, 0.0)
TRAFFIC = tp.Traffic("TRAFFIC", 45.31, -120.95, 680.0, -20.0, 1.5, -0.75, 3)
RESET = tp.SoftReset(45.306, -120.988001, 705.0)
ROUTE_REQUEST = tp.RouteRequest(
    "ASTAR", 45.3, -121.0, 700.0, 45.33, -120.95, 700.0, 90.0, 22.0, 0.0
)
"""Messages whose lines are known in each dialect."""


def _value(field: FieldLayout) -> st.SearchStrategy[Any]:
    if field.kind is Kind.WORD:
        return st.sampled_from([word.strip("_") for word in field.words])
    if field.kind is Kind.TEXT:
        return st.from_regex(r"[A-Za-z0-9_]{1,40}", fullmatch=True)
    if field.kind in (Kind.COUNT, Kind.BARE):
        high = getattr(tp.ORIGINAL_LIMITS, field.high) if field.high else 10**9
        low = -(10**9) if field.low is None else field.low
        return st.integers(low, high)
    if field.kind is Kind.DEGREES:
        most = 90 if "lat" in field.label else 180
        return st.integers(-most * 10**9, most * 10**9).map(lambda n: n / 10**9)
    return st.integers(-(10**12), 10**12).map(lambda n: n / 10**6)


def _message(layout: Layout) -> st.SearchStrategy[tp.Message]:
    values = {f.attribute: _value(f) for f in layout.fields}
    if layout.message is tp.SetMode:
        values["epoch"] = st.none() | st.integers(0, 10**9)
    return st.builds(layout.message, **values)


def messages(direction: tp.Direction) -> st.SearchStrategy[tp.Message]:
    return st.one_of([_message(la) for la in LAYOUTS if la.direction is direction])
