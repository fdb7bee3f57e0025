"""The quick answer of a JSON Schema is that of jsonschema: on each keyword that ours use, and on files made wrong at random."""

from __future__ import annotations

import copy
import random
from datetime import date
from pathlib import Path
from typing import Any

import pytest
import yaml
from jsonschema import Draft202012Validator

from cratous.services.certify.report_schema import departures
from cratous.services.loading.schema import mission_schema
from cratous.spec.files.schema_check import fits

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
VALUES: list[Any] = [
    None, True, False, 0, 1, -1, 1.0, 1.5, float("nan"), 1e308, 2**70, "", "a", "abc", "b-1",
    [], [1], [1, "a"], [1, 2, 3], ["a", 1], {}, {"a": 1}, {"a": "x", "b": 2}, {"b": []}, {"x1": 0},
]  # fmt: skip
SCHEMAS: list[Any] = [
    {"type": "integer"}, {"type": "number"}, {"type": ["string", "null"]}, {"type": "boolean"},
    {"const": 1}, {"const": True}, {"const": None}, {"enum": [0, "a", False]},
    {"minimum": 1, "exclusiveMaximum": 1.5}, {"maximum": 1, "exclusiveMinimum": -1},
    {"minLength": 1, "maxLength": 2}, {"pattern": "^[a-b]"}, {"minItems": 1, "maxItems": 2},
    {"minProperties": 1, "maxProperties": 1}, {"required": ["a"]},
    {"properties": {"a": {"type": "integer"}}, "additionalProperties": False},
    {"properties": {"a": True}, "patternProperties": {"^x": {"const": 0}, "^a": {"type": "integer"}},
     "additionalProperties": {"type": "array"}},
    {"propertyNames": {"maxLength": 1}}, {"items": {"type": "integer"}},
    {"prefixItems": [{"type": "integer"}], "items": {"type": "string"}},
    {"prefixItems": [True, False]}, {"anyOf": [{"type": "string"}, {"minimum": 1}]},
    {"oneOf": [{"type": "integer"}, {"minimum": 1}]}, {"allOf": [{"type": "integer"}, {"maximum": 0}]},
    {"if": {"type": "string"}, "then": {"minLength": 2}, "else": {"type": "integer"}},
    {"then": False}, {"$ref": "#/$defs/list", "$defs": {"list": {"items": {"$ref": "#/$defs/list"}}}},
    {"$ref": "#/$defs/one", "maximum": 0, "$defs": {"one": {"type": "integer"}}}, True, False,
]  # fmt: skip


@pytest.mark.parametrize("schema", SCHEMAS, ids=str)
def test_each_keyword_says_what_jsonschema_says(schema: Any) -> None:
    quick, slow = fits(schema), Draft202012Validator(schema)
    for value in VALUES:
        # of what is no number at all, NaN, only the words of jsonschema say something
        assert quick(value) == slow.is_valid(value) or (value != value and not quick(value))


def test_what_is_no_json_does_not_fit() -> None:
    for value in (date(2026, 1, 1), {1: 2}):
        assert not fits({"maximum": 1})(value)


def spoilt(value: Any, rng: random.Random) -> Any:
    """A copy with one thing in it changed, left out or added."""
    value = copy.deepcopy(value)
    at = value
    while True:
        keys = list(at) if isinstance(at, dict) else list(range(len(at)))
        key = rng.choice(keys)
        if isinstance(at[key], (dict, list)) and at[key] and rng.random() < 0.8:
            at = at[key]
            continue
        how = rng.randrange(4)
        if how == 0:
            del at[key]
        elif how == 1 and isinstance(at, dict):
            at["odd"] = 1
        else:
            at[key] = rng.choice(VALUES)
        return value


@pytest.mark.parametrize("name", ["crossing", "search", "popup", "sensed"])
def test_missions_made_wrong_are_found(name: str) -> None:
    good = yaml.safe_load((EXAMPLES / name / "mission.yaml").read_text("utf-8"))
    quick, slow = fits(mission_schema()), Draft202012Validator(mission_schema())
    assert quick(good)
    rng = random.Random(name)
    answers = set()
    for _ in range(25):
        other = spoilt(good, rng)
        answers.add(quick(other))
        assert quick(other) == slow.is_valid(other), other
    assert answers == {True, False}


def test_the_schema_of_reports_is_asked() -> None:
    (first, *_) = departures({})
    assert "required" in first
