"""The runs of a campaign: each with the text of its mission, its seed and its options, and a name from these."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import dataclass
from random import Random
from typing import Any

from cratous.services.campaign.definition import Campaign, Option, Source, Variable
from cratous.services.campaign.generators import mission_of
from cratous.services.campaign.identity import fingerprint
from cratous.services.loading.document import item_key
from cratous.spec.errors import BadInput


@dataclass(frozen=True)
class Run:
    """One run. id: a digest of all that decides its result, `decides`.

    decides: mission (text of the file), seed (of the mission's own variants, 0 for none), daa,
    allow_unproved, judge, version. drawn: what was drawn for it, by name.
    """

    id: str
    mission: str
    option: str
    seed: int
    decides: dict[str, Any]
    drawn: dict[str, Any]

    @property
    def name(self) -> str:
        """A name for people and folders; unique in the campaign."""
        return f"{self.mission}-{self.option}" + (f"-seed{self.seed}" if self.seed else "")


def runs_of(campaign: Campaign, version: str, allow_unproved: bool) -> Iterator[Run]:
    """All runs, in the order of missions, seeds and options."""
    for seed in campaign.seeds or (0,):
        for source in campaign.missions or (None,):
            for option in campaign.options:
                text, own_seed, drawn = _written(campaign, source, seed, option)
                decides = {
                    "mission": text, "seed": own_seed, "daa": option.daa, "judge": campaign.judge,
                    "allow_unproved": allow_unproved, "version": version,
                }  # fmt: skip
                name = campaign.name if source is None else source.name
                yield Run(fingerprint(decides), name, option.name, seed, decides, drawn)


def _written(
    campaign: Campaign, source: Source | None, seed: int, option: Option
) -> tuple[str, int, dict[str, Any]]:
    """The text of the mission file, the seed of its own variants, and what was drawn."""
    drawn: dict[str, Any] = {}
    own_seed = 0
    if source is None:
        data, drawn = mission_of(campaign.generator or {}, campaign.name, seed)
    else:
        own_seed = seed if source.varies else 0
        if not campaign.vary and not option.changes:
            return source.text, own_seed, drawn
        data = copy.deepcopy(source.document.data)
    drawn = dict(drawn)
    for variable in campaign.vary:
        drawn[variable.item] = _drawn(variable, seed)
        put(data, variable.item, drawn[variable.item])
    for item, value in option.changes:
        put(data, item, value)
    return _text(data), own_seed, drawn


def _text(data: dict[str, Any]) -> str:
    import yaml

    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)  # the first is libyaml: ten times faster
    text: str = yaml.dump(data, Dumper=dumper, sort_keys=False, allow_unicode=True, width=100)
    return text


def _drawn(variable: Variable, seed: int) -> Any:
    """The value for a seed; each item has draws of its own."""
    random = Random(f"{seed} {variable.item}")
    if variable.bounds is None:
        return random.choice(variable.values)
    return round(random.uniform(*variable.bounds), 6)


def put(data: Any, item: str, value: Any) -> None:
    """Set a value of a mission by its path; a mapping on the way is made if it is not there."""
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
