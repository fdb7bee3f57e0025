"""The compiled reading: a kernel over numpy arrays, by numba; and the exact one, on rationals.

The kernel's own source and that of everything it calls is written, unchanged but for the
decorators, into a module in a private cache folder that is named by the hash of that text, and
compiled there. So machine code can never outlive the source it was made from. No fastmath, no
parallel loops: the result of each element is what CPython computes on doubles.
"""

from __future__ import annotations

import functools
import importlib.util
import inspect
import os
import sys
import textwrap
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any, get_type_hints

import numpy as np

from cratous.core.kernel import Fold
from cratous.core.sources import digest

FLAGS = "njit(cache=True, fastmath=False, error_model='python')"


def cache_folder() -> Path:
    """Where compiled kernels live: $CRATOUS_CACHE, else the user's cache folder."""
    base = os.environ.get("CRATOUS_CACHE") or os.environ.get("XDG_CACHE_HOME")
    root = Path(base) if base else Path.home() / ".cache"
    return root / "cratous"


def _collect(function: Any, found: dict[str, str]) -> None:
    """Sources of a kernel and of what it uses, callees first."""
    if function.__name__ in found:
        return
    if not inspect.isclass(function):
        for name in function.__code__.co_names:
            value = function.__globals__.get(name)
            ours = getattr(value, "__module__", "").startswith("cratous.")
            if ours and (inspect.isfunction(value) or inspect.isclass(value)):
                _collect(value, found)
        for hint in get_type_hints(function).values():
            if inspect.isclass(hint) and hint.__module__.startswith("cratous."):
                _collect(hint, found)
    if inspect.isclass(function):
        found[function.__name__] = _constructor(function)
        return
    lines = textwrap.dedent(inspect.getsource(function)).splitlines()
    while not lines[0].startswith("def "):
        lines.pop(0)
    found[function.__name__] = "\n".join([f"@{FLAGS}", *lines])


def _constructor(record: Any) -> str:
    """A NamedTuple under another name, and a function of its own name that fixes field types.

    Kernels may write the integer literal 0 for a real field; machine code needs one type.
    """
    fields = get_type_hints(record)
    name = record.__name__
    lines = [f"class {name}_(NamedTuple):"]
    lines += [f"    {field}: {kind.__name__}" for field, kind in fields.items()]
    casts = ", ".join(f"{kind.__name__}({field})" for field, kind in fields.items())
    lines += ["", "", f"@{FLAGS}", f"def {name}({', '.join(fields)}):"]
    return "\n".join([*lines, f"    return {name}_({casts})"])


def _flat(hint: Any) -> int:
    """How many scalars an argument of this type holds."""
    fields = get_type_hints(hint) if inspect.isclass(hint) and issubclass(hint, tuple) else {}
    return len(fields) or 1


def _map_source(kernel: Callable[..., Any]) -> str:
    hints = get_type_hints(kernel)
    arrays, values = [], []
    for name in inspect.signature(kernel).parameters:
        count = _flat(hints[name])
        columns = [f"{name}_{k}" for k in range(count)] if count > 1 else [name]
        arrays += columns
        inner = ", ".join(f"{column}[i]" for column in columns)
        values.append(f"{hints[name].__name__}({inner})" if count > 1 else inner)
    return (
        f"@{FLAGS}\ndef _map(out, {', '.join(arrays)}):\n"
        f"    for i in range(out.size):\n"
        f"        out[i] = {kernel.__name__}({', '.join(values)})\n"
    )


def _module(text: str) -> Any:
    name = "kernels_" + digest([text])[:32]
    folder = cache_folder() / name
    file = folder / f"{name}.py"
    if not file.is_file() or file.read_text(encoding="utf-8") != text:
        folder.mkdir(parents=True, exist_ok=True)
        part = file.with_suffix(f".{os.getpid()}")
        part.write_text(text, encoding="utf-8")
        part.replace(file)
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise ImportError(f"compiled kernels cannot be loaded from {folder}")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # numba's cache finds the functions by this name
    spec.loader.exec_module(module)
    return module


@functools.cache
def compiled(kernel: Callable[..., Any]) -> Callable[..., np.ndarray]:
    """The kernel as a function of arrays: one array for each scalar, vectors field by field.

    All arrays have one length n (broadcast them first); the result has n elements, of type bool,
    int64 or float64 as the kernel's.
    """
    kind = {bool: np.bool_, int: np.int64, float: np.float64}[get_type_hints(kernel)["return"]]
    found: dict[str, str] = {}
    _collect(kernel, found)
    head = "from typing import NamedTuple\n\nfrom numba import njit\n"
    loop = _module("\n\n".join([head, *found.values(), _map_source(kernel)]))._map

    def run(*columns: Any) -> np.ndarray:
        arrays = np.broadcast_arrays(*[np.asarray(column) for column in columns])
        flat = [np.ascontiguousarray(array).reshape(-1) for array in arrays]
        out: np.ndarray = np.empty(flat[0].size, dtype=kind)
        loop(out, *flat)
        return out.reshape(arrays[0].shape)

    return run


def _rational(value: Any) -> Any:
    if isinstance(value, float):
        return Fraction(value)
    if isinstance(value, tuple):
        parts = [_rational(part) for part in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    return value


def exact(function: Callable[..., Any] | Fold[Any], *args: Any) -> Any:
    """The exact reading: run a division-free kernel or fold on the rationals the doubles are.

    Raises ValueError for an argument that is not finite: it has no exact reading.
    """
    try:
        if isinstance(function, Fold):
            items, *context = args
            return function([_rational(tuple(i)) for i in items], *map(_rational, context))
        return function(*map(_rational, args))
    except OverflowError as error:
        raise ValueError(f"{function.__name__}: an argument is not finite") from error
