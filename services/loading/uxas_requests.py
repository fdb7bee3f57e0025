"""The automation requests of a UxAS configuration, each with the messages valid when it is sent."""

from __future__ import annotations

from dataclasses import replace

from cratous.services.loading.request_kinds import is_request
from cratous.services.loading.uxas_cfg import Configuration
from cratous.spec.errors import BadInput


def requests_of(cfg: Configuration) -> tuple[Configuration, ...]:
    """The configuration for each automation request, in sending order.

    Of repeated messages a request uses the last one before it; if there is none, the first one
    after it, since a request waits for what it names. This also applies to a single request.
    """
    places = [k for k, sent in enumerate(cfg.messages) if is_request(type(sent.body).__name__)]
    if not places:  # a caller that needs one reports that there is none
        return (cfg,)
    found = []
    for place in places:
        rest = [(k, m) for k, m in enumerate(cfg.messages) if k not in places]
        before = tuple(m for k, m in rest if k < place)
        later = tuple(m for k, m in reversed(rest) if k > place)
        found.append(replace(cfg, messages=(*later, *before, cfg.messages[place])))
    return tuple(found)


def request_of(cfg: Configuration, number: int, where: str) -> tuple[Configuration, int]:
    """The configuration for the request with a number, counted from 1, and the number of requests;
    BadInput if there is no such request; where: the input, for messages.
    """
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
