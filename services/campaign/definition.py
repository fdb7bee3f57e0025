"""A campaign as data, read from its file (schema `spec/campaign/campaign.schema.json`) or from one mission."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from functools import cache
from importlib.resources import files
from itertools import product
from pathlib import Path
from typing import Any

from cratous.services.campaign.encounters import REQUIREMENTS as HELD
from cratous.services.campaign.generators import CASES, CHANGES, PARAMETERS
from cratous.services.campaign.recorded_encounter import ENDINGS, mission_of_states
from cratous.services.loading import load
from cratous.services.loading.document import Document, parse_document, read_document
from cratous.services.loading.problems import refuse
from cratous.services.loading.schema import schema_problems
from cratous.services.requirements.requirement_files import OwnFile, own_file, refuse_clashes
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import MISSION_BYTES
from cratous.spec.files.text_file import text_of

MOST_RUNS = 1_000_000
ALL = ("G1", "G2", "G3", "G4", "G5")
MISSIONS, ENCOUNTERS = "missions", "encounters"
"""Kinds: whole flights, or short encounters with avoidance and motion only."""
DURATION_S = 60.0
"""How long an encounter is flown [s]."""


@dataclass(frozen=True)
class Option:
    """A configuration for each mission: avoidance on or off, and changed values by their path."""

    name: str = "as-written"
    daa: bool = True
    changes: tuple[tuple[str, Any], ...] = ()


@dataclass(frozen=True)
class Variable:
    """A mission value drawn for each seed: from a range, or from a list of values."""

    item: str
    bounds: tuple[float, float] | None = None
    values: tuple[Any, ...] = ()


@dataclass(frozen=True)
class Limits:
    """Limits of an attempt: wall time [s], memory [MB]; and the number of attempts per run."""

    time_s: float = 600.0
    memory_mb: int = 4096
    attempts: int = 3


@dataclass(frozen=True)
class Source:
    """A mission file: its name in tables, its text, and its data."""

    name: str
    text: str
    document: Document

    @property
    def varies(self) -> bool:
        """Whether the mission has variants of its own."""
        return "variation" in self.document.data


@dataclass(frozen=True)
class Campaign:
    """Content of a campaign file. seeds: empty if every mission is run once, unvaried.

    requirements: what every run has to satisfy, guarantees first; own: files that contain the other
    ones. model: the log of every flight is checked against the proved steps of authority.
    """

    name: str
    missions: tuple[Source, ...] = ()
    generator: dict[str, Any] | None = None
    seeds: range = range(0)
    vary: tuple[Variable, ...] = ()
    options: tuple[Option, ...] = (Option(),)
    requirements: tuple[str, ...] = ALL
    judge: bool = True
    limits: Limits = field(default_factory=Limits)
    description: str = ""
    kind: str = MISSIONS
    duration_s: float = DURATION_S
    own: tuple[OwnFile, ...] = ()
    model: bool = False

    @property
    def random(self) -> bool:
        """Whether its runs are random draws, so that rates can be estimated."""
        return len(self.seeds) > 0


@cache
def campaign_schema() -> dict[str, Any]:
    """The published JSON Schema."""
    text = files("cratous.spec.campaign").joinpath("campaign.schema.json").read_text("utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


def load_campaign(
    path: Path, seeds: range | None, options: tuple[Option, ...], own: tuple[OwnFile, ...] = ()
) -> Campaign:
    """The campaign in a file, or of one mission file with the given seeds and options.

    own: user requirements that every run also has to satisfy. BadInput with file, line, item,
    expected and got.
    """
    if path.is_dir() and (path / "mission.yaml").is_file():
        path = path / "mission.yaml"
    if path.is_dir() or path.suffix.lower() not in (".yaml", ".yml"):
        raise BadInput(
            "a campaign is made of mission files (a UxAS configuration is several files and has no variants)",
            where=str(path), expected="a campaign or a mission whose name ends in .yaml or .yml",
            got="a folder" if path.is_dir() else path.suffix or "none",
        )  # fmt: skip
    document = read_document(path)
    data = document.data
    if isinstance(data, dict) and {"missions", "generator"} & set(data):
        found = _campaign(document, path.parent, seeds)
    else:
        source = _source(path)
        name = str(data.get("name", path.stem)) if isinstance(data, dict) else path.stem
        found = Campaign(name, (source,), seeds=seeds or range(0), options=options or (Option(),))
    found = _with_own(found, own)
    _check(found, document)
    return found


def _with_own(campaign: Campaign, more: tuple[OwnFile, ...]) -> Campaign:
    """The campaign with the requirements in these files added."""
    files = (*campaign.own, *more)
    refuse_clashes(files)
    names = [one.name for file in files for one in file.specification().requirements]
    return replace(campaign, own=files, requirements=(*campaign.requirements, *names))


def _source(path: Path, kind: str = MISSIONS, duration_s: float = DURATION_S) -> Source:
    if path.suffix.lower() in ENDINGS:
        if kind != ENCOUNTERS:
            raise BadInput(
                "a file of states is no whole mission", where=str(path), item="missions",
                expected=f"a mission (.yaml), or kind: {ENCOUNTERS}", got=path.suffix,
            )  # fmt: skip
        data = mission_of_states(path, duration_s)
        return Source(data["name"], "", Document(str(path), data, {}))
    text = text_of(path, MISSION_BYTES, "a mission file")
    document = parse_document(text, str(path))
    load(path)  # errors of the unvaried mission are reported before anything is flown
    return Source(document.data["name"], text, document)


def _campaign(document: Document, folder: Path, seeds: range | None) -> Campaign:
    refuse(schema_problems(document, campaign_schema()))
    data = document.data
    if ("missions" in data) == ("generator" in data):
        raise _wrong(document, ("generator",), "missions and a generator", "one of the two", "both")
    if seeds is None and "seeds" in data:
        first, last = data["seeds"]
        if first > last:
            expected = "the first seed, then the last"
            raise _wrong(document, ("seeds",), "no seeds", expected, f"{first}, {last}")
        seeds = range(first, last + 1)
    kind = data.get("kind", MISSIONS)
    duration_s = float(data.get("duration_s", DURATION_S))
    asked = data.get("requirements", HELD if kind == ENCOUNTERS else ALL)
    options = tuple(
        Option(o["name"], o.get("daa", True), tuple(sorted(o.get("set", {}).items())))
        for o in data.get("options", [])
    )
    return Campaign(
        name=data["name"],
        missions=tuple(
            _source(folder / name, kind, duration_s) for name in data.get("missions", [])
        ),
        generator=data.get("generator"),
        seeds=seeds or range(0),
        vary=tuple(_variable(document, k, v) for k, v in enumerate(data.get("vary", []))),
        options=options or (Option(),),
        requirements=tuple(sorted(set(asked) & set(ALL))),
        judge=data.get("judge", True),
        limits=Limits(**data.get("limits", {})),
        description=data.get("description", ""),
        kind=kind,
        duration_s=duration_s,
        own=tuple(own_file(folder / name, name) for name in asked if name not in ALL),
        model=data.get("model", False),
    )


def _variable(document: Document, k: int, data: dict[str, Any]) -> Variable:
    if "values" in data:
        return Variable(data["item"], values=tuple(data["values"]))
    low, high = data["range"]
    _ordered(document, ("vary", k, "range"), low, high)
    return Variable(data["item"], (float(low), float(high)))


def _ordered(document: Document, key: tuple[str | int, ...], low: float, high: float) -> None:
    if low > high:
        expected = "lower bound, then upper bound"
        raise _wrong(document, key, "an empty range", expected, f"{low:g}, {high:g}")


def _check(campaign: Campaign, document: Document) -> None:
    _check_kind(campaign, document)
    made = campaign.generator or {"kind": ""}
    for item in sorted(made.keys() - {"kind"}):
        if (item == "most_changes") != (made["kind"] == CHANGES):
            expected = f"most_changes under the kind {CHANGES}, the others under the other kinds"
            key = ("generator", item)
            raise _wrong(
                document,
                key,
                f"a generator of kind {made['kind']} has no such item",
                expected,
                item,
            )
    _check_ranges(document, ("generator",), made)
    _check_cases(document, made.get(CASES, {}), campaign.vary)
    if (campaign.generator or campaign.vary) and not campaign.seeds:
        expected = "seeds: [first, last], or --seeds A-B"
        raise _wrong(document, ("seeds",), "nothing to draw with", expected, "no seeds")
    for source in campaign.missions:
        if campaign.seeds and not (source.varies or campaign.vary):
            raise BadInput(
                "this mission has no variants", where=source.document.path, item="variation",
                expected="a variation section, or a campaign that says what varies", got="seeds",
            )  # fmt: skip
    for what, names in (
        ("missions", [source.name for source in campaign.missions]),
        ("options", [option.name for option in campaign.options]),
    ):
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise _wrong(document, (what,), "a name is used twice", "names that differ", twice[0])
    runs = max(1, len(campaign.missions)) * len(campaign.options) * max(1, len(campaign.seeds))
    if runs > MOST_RUNS:
        raise _wrong(document, ("seeds",), "too many runs", f"at most {MOST_RUNS}", str(runs))


def _check_ranges(document: Document, key: tuple[str | int, ...], made: dict[str, Any]) -> None:
    for name, (low, high) in made.get("ranges", {}).items():
        _ordered(document, (*key, "ranges", name), low, high)


def _check_cases(document: Document, things: dict[str, Any], vary: tuple[Variable, ...]) -> None:
    """Refuse cases that set a value set by another case group, or that have the name of a drawn
    parameter: both would share a column in the results.
    """
    drawn = {*PARAMETERS, *(one.item for one in vary)}
    said: dict[str, str] = {}
    for what, cases in things.items():
        if what in drawn:
            expected = "a name of its own"
            raise _wrong(document, ("generator", CASES, what), "drawn already", expected, what)
        mine = set[str]()
        for name, case in cases.items():
            _check_ranges(document, ("generator", CASES, what, name), case)
            mine |= {
                *(case.keys() - {"ranges", "set"}),
                *case.get("ranges", {}),
                *case.get("set", {}),
            }
        for item, other in product(sorted(mine), sorted(said)):
            if _within(item, other) or _within(other, item):
                expected = f"one thing to say it: {said[other]} says {other}"
                key = ("generator", CASES, what)
                raise _wrong(document, key, "said by two things", expected, item)
        said |= dict.fromkeys(mine, what)


def _within(item: str, other: str) -> bool:
    """Whether one item equals another or is a part of it."""
    return f"{item}.".replace("[", ".[").startswith(f"{other}.".replace("[", ".["))


def _check_kind(campaign: Campaign, document: Document) -> None:
    """Refuse options that do not suit the kind: encounters have no bridge, log or changes and are
    always judged; whole flights have no duration.
    """
    if campaign.kind == MISSIONS:
        if isinstance(document.data, dict) and "duration_s" in document.data:
            what = "a whole flight has no duration"
            raise _wrong(document, ("duration_s",), what, f"kind: {ENCOUNTERS}", MISSIONS)
        return
    for name in (one for one in campaign.requirements if one not in HELD):
        what = "an encounter has no bridge and no log, so nothing is known of it"
        raise _wrong(document, ("requirements",), what, ", ".join(HELD), name)
    if campaign.model:
        what = "an encounter has no log, so no steps of authority"
        raise _wrong(document, ("model",), what, f"false, or kind: {MISSIONS}", "true")
    if not campaign.judge:
        raise _wrong(document, ("judge",), "encounters are always judged", "true", "false")
    if (campaign.generator or {}).get("kind") == CHANGES:
        what = "an encounter has no changes in flight"
        raise _wrong(document, ("generator", "kind"), what, "another kind", CHANGES)


def _wrong(
    document: Document, key: tuple[str | int, ...], what: str, expected: str, got: str
) -> BadInput:
    from cratous.services.loading.document import item_name

    return BadInput(
        what, where=document.where(key), item=item_name(key), expected=expected, got=got
    )
