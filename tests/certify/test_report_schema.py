"""The published schema of report.json: reports fit it, and what does not is neither written nor confirmed."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from certify_tools import Run, edited, read
from jsonschema import Draft202012Validator
from record_schema import record_definitions

from cratous.services.certify.report import write_report
from cratous.services.certify.report_schema import departures, schema_text
from cratous.spec.mission import Mission, changes
from cratous.spec.mission.plan import PartialPlan, Plan

SCHEMA = json.loads(schema_text())


def test_it_is_a_schema_and_is_printed(run: Run) -> None:
    Draft202012Validator.check_schema(SCHEMA)
    code, out, err = run("certify", "--schema")
    assert (code, json.loads(out), err) == (0, SCHEMA, "")


def test_mission_and_plan_are_those_of_the_records() -> None:
    """A field that a record gets or loses is one that the published schema must get or lose."""
    assert changes.WindChange.__name__ in SCHEMA["$defs"]  # a record of a module of its own
    found = record_definitions(Mission, Plan)
    assert {"Mission", "Plan", "PartialPlan", "Zone", "Vehicle", "Task"} <= set(found)
    for name, record in ((Plan.__name__, Plan), (PartialPlan.__name__, PartialPlan)):
        hashed = copy.deepcopy(SCHEMA["$defs"][f"Hashed{name}"])
        assert hashed["properties"].pop("hash")["pattern"]
        hashed["required"].remove("hash")
        assert found.pop(record.__name__) == hashed
    assert {name: SCHEMA["$defs"][name] for name in found} == found


def test_tracks_are_looked_at_apart_as_the_schema_has_them() -> None:
    """What `report_schema` asks of them itself is all that the schema asks."""
    tracks = SCHEMA["properties"]["flight"]["properties"]["tracks"]
    rows = {"type": "array", "items": {"type": "number"}, "minItems": 5, "maxItems": 5}
    assert {k: v for k, v in tracks.items() if k != "description"} == {
        "type": "object",
        "propertyNames": {"pattern": "^-?[0-9]+$"},
        "additionalProperties": {"type": "array", "items": rows},
    }


def test_a_hint_that_no_record_uses_is_refused() -> None:
    class Odd(tuple):
        _fields = ("field",)
        __annotations__ = {"field": set}

    with pytest.raises(TypeError, match="no schema for"):
        record_definitions(Odd)


def objects(schema: Any) -> Iterator[dict[str, Any]]:
    if isinstance(schema, dict):
        if schema.get("type") == "object":
            yield schema
        for part in schema.values():
            yield from objects(part)
    elif isinstance(schema, list):
        for part in schema:
            yield from objects(part)


def test_nothing_unknown_is_allowed_anywhere() -> None:
    found = list(objects(SCHEMA))
    assert len(found) > 40
    assert all("additionalProperties" in one for one in found)
    assert all(one["additionalProperties"] is not True for one in found)


def test_a_report_fits_and_its_edits_do_not(flown: Path) -> None:
    whole = read(flown)
    assert departures(whole) == []
    edits: list[tuple[tuple[Any, ...], Any, str]] = [
        (("verdict",), "passed", "verdict: 'passed' is not one of"),
        (("exit_code",), 2, "exit_code: 2 is not one of"),
        (("constraints", 0, "checks"), -1, "constraints[0].checks: -1 is less than"),
        (("constraints", 0, "margin"), "12", "constraints[0].margin: '12' is not of type"),
        (("constraints", 0, "added"), 1, "constraints[0]: Additional properties"),
        (("log", "digest"), "x" * 64, "log.digest: "),
        (("flight", "tracks", "1", 0), [1, 2, 3], "flight.tracks.1[0]: [1, 2, 3] is too short"),
        (
            ("flight", "tracks", "1", 0),
            [1, 2, 3, "4", 5],
            "flight.tracks.1[0][3]: '4' is not of type",
        ),
        (
            ("flight", "tracks", "1", 0),
            [1, 2, True, 4, 5],
            "flight.tracks.1[0][2]: True is not of type",
        ),
        (("flight", "tracks", "1", 0, 4), None, "flight.tracks.1[0][4]: None is not of type"),
        (("flight", "tracks", "2"), {}, "flight.tracks.2: {} is not of type"),
        (("flight", "tracks", "x"), [], "flight.tracks: 'x' does not match"),
        (("mission", "frame"), None, "mission.frame: None is not of type"),
        (("environment", "packages", "numpy"), 2, "environment.packages.numpy: 2 is not"),
    ]
    for path, new, said in edits:
        bad = copy.deepcopy(whole)
        place = bad
        for part in path[:-1]:
            place = place[part]
        place[path[-1]] = new
        found = departures(bad)
        assert any(line.startswith(said) for line in found), (path, found)
    for key in whole:
        bad = {name: value for name, value in whole.items() if name != key}
        assert any(f"{key!r} is a required property" in line for line in departures(bad))
    assert len(departures({**whole, "flight": {**whole["flight"], "events": [0] * 999}})) == 20
    assert not any("\x1b" in line for line in departures({**whole, "verdict": "\x1b[2J"}))


def test_what_does_not_fit_is_not_written(flown: Path, tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="verdict: 'good' is not one of"):
        write_report({**read(flown), "verdict": "good"}, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_certify_says_what_does_not_fit(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    folder = edited(flown, tmp_path)
    whole = {**read(folder), "approved": True}
    (folder / "report.json").write_text(json.dumps(whole), encoding="utf-8")
    code, _, err = run("certify", folder)
    assert code == 1
    assert "report.json, by its schema: report: Additional properties are not allowed" in err
