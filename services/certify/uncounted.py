"""Loops as they are written, without the entries that count calls (`services.certify.evidence`).

While calls are counted, each registered function has an entry that counts and forwards. In a loop that is counted as
a whole those entries cost more than what they forward to, so the loop runs as a copy: the same code objects, in
copies of their modules' names in which every function that it reaches is a copy too.
"""

from __future__ import annotations

import dis
import inspect
from collections.abc import Callable
from types import FunctionType
from typing import Any

from cratous.core.kernel import qualified
from cratous.core.kernel.sources import names_of, ours

ASSIGNING = frozenset(dis.opmap[name] for name in ("STORE_GLOBAL", "DELETE_GLOBAL"))
"""Instructions that assign to names of a module."""


def entered(function: Callable[..., Any]) -> dict[str, FunctionType]:
    """The functions that a function calls directly or indirectly by the names of their modules, itself included, each
    as it is when its calls are not counted; by qualified name.
    """
    found: dict[str, FunctionType] = {}
    todo: list[Any] = [function]
    while todo:
        value = todo.pop()
        if qualified(value) in found:
            continue
        plain = inspect.unwrap(value)
        found[qualified(value)] = plain
        for used in names_of(plain.__code__):
            callee = plain.__globals__.get(used)
            if inspect.isfunction(callee) and ours(callee):
                todo.append(callee)
    return found


def uncounted(function: Callable[..., Any]) -> Callable[..., Any]:
    """A copy of a function that calls copies of all that it reaches, none of which counts its calls.

    The function itself where a copy would not be the same: where one assigns to names of its module.
    """
    reached = entered(function)
    if any(_assigns(one) for one in reached.values()):
        return function
    scopes: dict[int, dict[str, Any]] = {}
    copies: dict[str, FunctionType] = {}
    for name, plain in reached.items():
        scope = scopes.setdefault(id(plain.__globals__), dict(plain.__globals__))
        copies[name] = _copy(plain, scope)
    for scope in scopes.values():
        for used, value in scope.items():
            if inspect.isfunction(value) and qualified(value) in copies:
                scope[used] = copies[qualified(value)]
    return copies[qualified(function)]


def _assigns(plain: FunctionType) -> bool:
    # an instruction is two bytes, of which the first says which; the caches after it are zeros here
    return not ASSIGNING.isdisjoint(plain.__code__.co_code[::2])


def _copy(plain: FunctionType, scope: dict[str, Any]) -> FunctionType:
    made = FunctionType(
        plain.__code__, scope, plain.__name__, plain.__defaults__, plain.__closure__
    )
    made.__kwdefaults__ = plain.__kwdefaults__
    return made
