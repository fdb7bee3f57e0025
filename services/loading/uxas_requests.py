"""The automation requests of a UxAS configuration: each with the messages as they are when it is sent."""

from __future__ import annotations

from dataclasses import replace

from cratous.services.loading.request_kinds import is_request
from cratous.services.loading.uxas_cfg import Configuration
from cratous.spec.errors import BadInput


def requests_of(cfg: Configuration) -> tuple[Configuration, ...]:
    """The configuration for each automation request, in the order in which they are sent.

    Of what is told several times a request means what was told last before it; where nothing was, what
    is told first after it, as a request waits for what it names. That holds for an only request, too.
    """
    places = [k for k, sent in enumerate(cfg.messages) if is_request(type(sent.body).__name__)]
    if not places:  # whoever needs one says that there is none
        return (cfg,)
    found = []
    for place in places:
        rest = [(k, m) for k, m in enumerate(cfg.messages) if k not in places]
        before = tuple(m for k, m in rest if k < place)
        later = tuple(m for k, m in reversed(rest) if k > place)
        found.append(replace(cfg, messages=(*later, *before, cfg.messages[place])))
    return tuple(found)


def request_of(cfg: Configuration, number: int, where: str) -> tuple[Configuration, int]:
    """The configuration for the request with a number, counted from 1, and how many there are; BadInput if
    there is no such one; where: what was read."""
    asked = requests_of(cfg)
    if number not in range(1, len(asked) + 1):
        raise BadInput(
            "there is no such request",
            where=where,
            item="request",
            expected=f"1 to {len(asked)}",
            got=str(number),
        )
    return asked[number - 1], len(asked)
