"""Small missions of one vehicle, one zone and a few tasks, planned so that what planning needs is there."""

from collections.abc import Sequence

_HEAD = """
frame: {latitude_deg: 45, longitude_deg: -120}
vehicles:
  - id: 1
    position: {north_m: 0, east_m: 0, alt_m: 300}
    heading_deg: 0
    speed_m_s: 20
    min_speed_m_s: 15
    max_speed_m_s: 30
    max_bank_deg: 30
    max_climb_m_s: 3
    cameras: [{payload_id: 1, hfov_deg: 45, pixels: 1000}]
zones:
  - id: 1
    kind: keep_out
    vertices: [[1000, -200], [1000, 200], [1200, 200], [1200, -200]]
tasks:
"""
TASKS = (
    "{kind: point_search, points: [{north_m: 4500, east_m: 0}]}",
    "{kind: line_search, points: [{north_m: 3000, east_m: 0}, {north_m: 3500, east_m: 300}, "
    "{north_m: 4000, east_m: 0}]}",
    "{kind: area_search, rectangle: {centre: {north_m: 2000, east_m: 0}, width_m: 600, height_m: 500}}",
    "{kind: must_fly, points: [{north_m: 5000, east_m: 0, alt_m: 300}]}",
)
"""One task of each kind: a place seen, footprints along a line, lanes with turns, a place flown over."""


def mission(name: str, tasks: Sequence[str]) -> str:
    """The text of a mission with these tasks, numbered from 1, and a zone on the way to them."""
    lines = (f"  - {{id: {number}, {text[1:]}" for number, text in enumerate(tasks, 1))
    return f"name: {name}{_HEAD}" + "\n".join(lines) + "\n"
