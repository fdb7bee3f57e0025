"""The runs of a campaign: each with mission text, seed and options, and an id derived from these."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from random import Random
from typing import Any

from cratous.services.campaign.definition import (
    ENCOUNTERS,
    MISSIONS,
    Campaign,
    Option,
    Source,
    Variable,
)
from cratous.services.campaign.generators import mission_of
from cratous.services.campaign.identity import fingerprint
from cratous.services.loading.document import item_key
from cratous.spec.errors import BadInput


@dataclass(frozen=True)
class Run:
    """One run. id: digest of `decides`, all inputs that determine its result.

    deciding gives: mission (text of the file), seed (of the mission's own variants, 0 for none),
    daa, allow_unproved, judge, model, version, kind, own (user requirement files as stored in a
    report). drawn: values drawn for it, by name.
    """

    id: str
    mission: str
    option: str
    seed: int
    deciding: Callable[[], dict[str, Any]]
    drawn: dict[str, Any]

    @property
    def decides(self) -> dict[str, Any]:
        """The inputs that determine a run, computed again each time: writing a mission's text takes
        longer than drawing it.
        """
        return self.deciding()

    @property
    def name(self) -> str:
        """Display and folder name, unique in the campaign."""
        return f"{self.mission}-{self.option}" + (f"-seed{self.seed}" if self.seed else "")


Ids = dict[tuple[str, str, int], str]
"""Ids of runs identified before, by mission, option and seed."""


def runs_of(
    campaign: Campaign, version: str, allow_unproved: bool, ids: Ids | None = None
) -> Iterator[Run]:
    """All runs, in the order of missions, seeds and options. ids: known ids, to which new ones are added."""
    for seed in campaign.seeds or (0,):
        for source in campaign.missions or (None,):
            for option in campaign.options:
                data = Made(campaign, source, option, seed)
                yield data.run(version, allow_unproved, ids)


class Made:
    """The mission file of one seed under one option, and the values drawn for it.

    given: values by name that are used instead of draws. bounds: range of each drawn number;
    choices: alternatives of each other draw, including sides.
    """

    def __init__(
        self,
        campaign: Campaign,
        source: Source | None,
        option: Option,
        seed: int,
        given: Mapping[str, Any] | None = None,
    ) -> None:
        self._option, self._judge, self._seed = option, campaign.judge, seed
        self._model = campaign.model
        self._own = [file.data() for file in campaign.own]
        self.drawn: dict[str, Any] = {}
        self.bounds: dict[str, tuple[float, float]] = {}
        self.choices: dict[str, tuple[Any, ...]] = {}
        self._name, self._own_seed, self._text = campaign.name, 0, ""
        if source is None:
            self.data, draw = mission_of(campaign.generator or {}, campaign.name, seed, given)
            self.drawn, self.bounds = dict(draw.drawn), dict(draw.bounds)
            self.choices = dict(draw.choices)
            for item, value in draw.values.items():
                put(self.data, item, value)
        else:
            self._name, self._own_seed = source.name, seed if source.varies else 0
            unchanged = not campaign.vary and not option.changes and campaign.kind == MISSIONS
            self._text = source.text if unchanged else ""
            self.data = copy.deepcopy(source.document.data)
        for variable in campaign.vary:
            value = (given or {}).get(variable.item, _drawn(variable, seed))
            self.drawn[variable.item] = value
            if variable.bounds is not None:
                self.bounds[variable.item] = variable.bounds
            else:
                self.choices[variable.item] = variable.values
            put(self.data, variable.item, value)
        self._kind = campaign.kind
        if campaign.kind == ENCOUNTERS:
            put(self.data, "simulation.limit_s", campaign.duration_s)
        for item, value in option.changes:
            put(self.data, item, value)
        if source is None and isinstance(self.data.get("sensing"), dict):
            # each generated mission has its own sensor errors, the same under all options
            self.data["sensing"].setdefault("seed", seed)

    def of(self, data: dict[str, Any]) -> Made:
        """The same with another mission file."""
        other = copy.copy(self)
        other.data, other._text = data, ""
        return other

    def run(self, version: str, allow_unproved: bool, ids: Ids | None = None) -> Run:
        """The run of the current mission."""

        def decides() -> dict[str, Any]:
            return {
                "mission": self._text or _text(self.data), "seed": self._own_seed, "daa": self._option.daa,
                "judge": self._judge, "allow_unproved": allow_unproved, "version": version,
                "kind": self._kind, "own": self._own, "model": self._model,
            }  # fmt: skip

        key = (self._name, self._option.name, self._seed)
        found = None if ids is None else ids.get(key)
        if found is not None:
            return Run(found, *key, decides, self.drawn)
        now = decides()
        made = fingerprint(now)
        if ids is not None:
            ids[key] = made
        return Run(made, *key, lambda: now, self.drawn)


def _text(data: dict[str, Any]) -> str:
    import yaml

    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)  # the first is libyaml: ten times faster
    text: str = yaml.dump(data, Dumper=dumper, sort_keys=False, allow_unicode=True, width=100)
    return text


def _drawn(variable: Variable, seed: int) -> Any:
    """The value for a seed; each item has its own random stream."""
    random = Random(f"{seed} {variable.item}")
    if variable.bounds is None:
        return random.choice(variable.values)
    return round(random.uniform(*variable.bounds), 6)


def put(data: Any, item: str, value: Any) -> None:
    """Set a value of a mission by its path; missing mappings on the path are created."""
    *way, last = item_key(item) or ("",)
    at = data
    for k, part in enumerate((*way, last)):
        if isinstance(part, int):
            known = isinstance(at, list) and part < len(at)
        else:
            known = isinstance(at, dict)
        if not known:
            raise BadInput(
                "the mission has no such value", item=item, expected="a path into the mission file",
                got=str(part),
            )  # fmt: skip
        if k == len(way):
            at[part] = copy.deepcopy(value)
        elif isinstance(part, int):
            at = at[part]
        else:
            at = at.setdefault(part, {})
