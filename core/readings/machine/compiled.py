"""The compiled reading: a kernel over numpy arrays, by numba.

A kernel without division, or with a record as result, is printed from its graph as straight-line
code, so that the compiler can work on several states at once; any other kernel, and every function
with loops (`machine`), is compiled from its own source and that of everything it calls, under names
that tell all of it apart (`source_text`). The text is written into a module in a private cache folder
that is named by the hash of that text, and compiled there. So machine code can never outlive the
source it was made from. No fastmath, no parallel loops: the result of each element is what CPython
computes on doubles.
"""

from __future__ import annotations

import contextlib
import functools
import importlib.util
import inspect
import math
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, get_type_hints

import numpy as np

from cratous.core.files.private_cache import private_cache
from cratous.core.kernel import Fold
from cratous.core.kernel.sources import digest
from cratous.core.readings.graph import program
from cratous.core.readings.graph.nodes import Node, NotInSubset, Program, Record, leaves
from cratous.core.readings.graph.printing import name as text_of
from cratous.core.readings.graph.printing import straight
from cratous.core.readings.machine.source_text import SourceText
from cratous.spec.errors import BadInput

FLAGS = "njit(cache=True, fastmath=False, error_model='python', no_cfunc_wrapper=True)"
QUIET = FLAGS.replace("'python'", "'numpy'")
"""For straight-line code with divisions: it evaluates both branches and selects one."""
WITHIN = FLAGS.replace("cache=True, ", "").replace(")", ", no_cpython_wrapper=True)")
"""For functions called only by machine code: they are part of their caller's code, without a Python entry point."""
KINDS: dict[Any, Any] = {bool: np.bool_, int: np.int64, float: np.float64}
MACHINE, EXACT, ENCLOSED = "machine code", "exact", "enclosed"
"""How a function is read if CPython does not run it as written."""


@dataclass(frozen=True, eq=False, slots=True)
class Reading:
    """A kernel, fold or loop in a reading other than CPython's; called as `run` is.

    function: what is read; how: MACHINE, EXACT or ENCLOSED. Every such reading is entered through this class, so that
    entries can be counted (`services/certify/evidence.py`).
    """

    function: Callable[..., Any] | Fold[Any]
    how: str
    run: Callable[..., Any]

    def __call__(self, *given: Any, **named: Any) -> Any:
        return self.run(*given, **named)


PREFIX = "kernels_"
"""Prefix of the cache folders of compiled text, before the hash of the text."""


def folder_name(text: str) -> str:
    """The folder of the cache that a text is compiled in."""
    return PREFIX + digest([text])[:32]


def load(text: str) -> Any:
    """The module of this text, from the cache folder; numba keeps its machine code beside it."""
    name = folder_name(text)
    folder = private_cache() / name
    file = folder / f"{name}.py"
    if not file.is_file() or file.read_text(encoding="utf-8") != text:
        folder.mkdir(exist_ok=True, mode=0o700)
        part = file.with_suffix(f".{os.getpid()}")
        part.write_text(text, encoding="utf-8")
        part.replace(file)
    with contextlib.suppress(OSError):
        os.utime(folder)  # when it was used last, for who prunes the cache
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise ImportError(f"compiled kernels cannot be loaded from {folder}")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # numba's cache finds the functions by this name
    spec.loader.exec_module(module)
    return module


# -- straight-line code from the graph ------------------------------------------------------
def loop_text(
    columns: tuple[Node, ...],
    scalars: frozenset[str],
    outs: str,
    body: list[str],
    flags: str = FLAGS,
) -> str:
    """`_map(outs..., columns...)`: the body for every element; `scalars` are single values."""
    arguments = [str(c.value) if c.value in scalars else f"a_{c.value}" for c in columns]
    lines = [
        "from math import sqrt",
        "",
        "from numba import njit",
        "",
        "",
        f"@{flags}",
        f"def _map({', '.join([outs, *arguments])}):",
        "    for i in range(out.size):",
    ]
    for column in columns:
        if column.value not in scalars:
            lines.append(f"        {column.value} = a_{column.value}[i]")
    return "\n".join([*lines, *body, ""])


@functools.cache
def _straight_map(source: Program, scalars: frozenset[str]) -> Any:
    result = source.result
    assert isinstance(result, Node)
    body = [*straight([result], "        "), f"        out[i] = {text_of(result)}"]
    return load(loop_text(source.columns, scalars, "out", body))._map


@functools.cache
def _record_map(source: Program, scalars: frozenset[str]) -> Any:
    parts = leaves(source.result)
    outs = ["out", *[f"out_{k}" for k in range(1, len(parts))]]
    store = [f"        {out}[i] = {text_of(part)}" for out, part in zip(outs, parts, strict=True)]
    body = [*straight(parts, "        "), *store]
    text = loop_text(source.columns, scalars, ", ".join(outs), body, QUIET)
    return load(text)._map


def _records(source: Program, *columns: Any, out: Any = None) -> Any:
    """A kernel with a record as result: the record of its fields' arrays."""
    flat, shape = checked(source, columns)
    parts = leaves(source.result)
    given = [None] * len(parts) if out is None else list(out)
    if len(given) != len(parts):
        raise BadInput(
            "out does not fit",
            where=source.name,
            item="out",
            expected=f"{len(parts)} arrays",
            got=str(len(given)),
        )
    kinds = {"float": np.float64, "int": np.int64, "bool": np.bool_}
    found = [
        outcome(source.name, o, shape, kinds[part.kind])
        for o, part in zip(given, parts, strict=True)
    ]
    _record_map(source, single(source, flat))(*found, *flat)
    return _record(source.result, [array.reshape(shape) for array in found])


def _record(shape: Any, arrays: list[Any]) -> Any:
    if isinstance(shape, Record):
        return shape.kind(*[_record(field, arrays) for field in shape.fields])
    return arrays.pop(0)


# -- the function's own source ------------------------------------------------------------
def _entry_text(function: Callable[..., Any]) -> tuple[SourceText, str]:
    made = SourceText(WITHIN, {function: FLAGS})
    made.add_arguments(function)
    return made, made.add(function)


@functools.cache
def machine(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function with loops in machine code, as written, with all that it calls (`source_text`).

    Arguments are numbers, arrays of float64, int64 or bool, and records of these, which the function's
    annotations name. CPython runs the same function, and gives the same results.
    """
    made, name = _entry_text(function)
    return Reading(function, MACHINE, getattr(load(made.text), name))


@functools.cache
def _kept_as(function: Callable[..., Any]) -> tuple[str, str]:
    """The cache folder with a function's machine code, and the name of its files."""
    made, name = _entry_text(function)
    return folder_name(made.text), f"*.{name}-*.nbc"


def is_kept(function: Callable[..., Any]) -> bool:
    """Whether `machine` finds this function's machine code in the cache, without compilation."""
    folder, files = _kept_as(function)
    return any((private_cache() / folder / "__pycache__").glob(files))


def _flat(hint: Any) -> int:
    """The number of scalars in an argument of this type."""
    fields = get_type_hints(hint) if inspect.isclass(hint) and issubclass(hint, tuple) else {}
    return len(fields) or 1


def _map_source(kernel: Callable[..., Any], text: SourceText) -> str:
    hints = get_type_hints(kernel)
    arrays, values = [], []
    for name in inspect.signature(kernel).parameters:
        count = _flat(hints[name])
        columns = [f"{name}_{k}" for k in range(count)] if count > 1 else [name]
        arrays += columns
        inner = ", ".join(f"{column}[i]" for column in columns)
        values.append(f"{text.add(hints[name])}({inner})" if count > 1 else inner)
    return (
        f"@{FLAGS}\ndef _map(out, {', '.join(arrays)}):\n"
        f"    for i in range(out.size):\n"
        f"        out[i] = {text.add(kernel)}({', '.join(values)})\n"
    )


@functools.cache
def _source_map(kernel: Callable[..., Any]) -> Any:
    made = SourceText(WITHIN)
    made.parts.append(_map_source(kernel, made))
    return load(made.text)._map


# -- the map ----------------------------------------------------------------------------
def aligned(columns: tuple[Any, ...]) -> tuple[list[Any], tuple[int, ...]]:
    """Columns as flat arrays of one length, with single values unchanged; and the common shape."""
    arrays = [np.asarray(column) for column in columns]
    shape = np.broadcast_shapes(*[array.shape for array in arrays])
    if shape == ():
        return [array.reshape(1) for array in arrays], shape
    flat = [
        array[()]
        if array.ndim == 0
        else np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1)
        for array in arrays
    ]
    return flat, shape


def outcome(where: str, out: np.ndarray | None, shape: tuple[int, ...], kind: Any) -> np.ndarray:
    """The flat array for the results: `out` if it is given and fits, else a new one."""
    size = math.prod(shape)
    if out is None:
        return np.empty(size, dtype=kind)
    if out.shape != shape or out.dtype != kind or not out.flags.c_contiguous:
        raise BadInput(
            "out does not fit",
            where=where,
            item="out",
            expected=f"a contiguous array of {np.dtype(kind).name}, shape {shape}",
            got=f"{out.dtype.name}, shape {out.shape}",
        )
    return out.reshape(-1)


def single(source: Program, flat: list[Any]) -> frozenset[str]:
    """The names of the columns that are single values."""
    pairs = zip(source.columns, flat, strict=True)
    return frozenset(str(column.value) for column, value in pairs if np.ndim(value) == 0)


def checked(source: Program, columns: tuple[Any, ...]) -> tuple[list[Any], tuple[int, ...]]:
    """Flat columns of the kernel's own types, and the common shape.

    Raises BadInput for a wrong number of columns, shapes or types that do not fit, and for a
    number that its column's type cannot hold.
    """
    if len(columns) != len(source.columns):
        raise BadInput(
            "a wrong number of columns",
            where=source.name,
            expected=f"{len(source.columns)} ({', '.join(source.labels)})",
            got=str(len(columns)),
        )
    try:
        flat, shape = aligned(columns)
    except ValueError as error:
        raise BadInput(
            "the columns cannot be broadcast to one shape", where=source.name, got=str(error)
        ) from error
    for k, (column, label) in enumerate(zip(source.columns, source.labels, strict=True)):
        flat[k] = _typed(source.name, column.kind, label, flat[k])
    return flat, shape


def _typed(where: str, kind: str, label: str, value: Any) -> Any:
    array, wanted = np.asarray(value), KINDS[{"float": float, "int": int, "bool": bool}[kind]]
    if array.dtype == wanted:
        return value
    if array.dtype.kind not in {"float": "fiu", "int": "iu", "bool": "b"}[kind]:
        raise BadInput(f"not of type {kind}", where=where, item=label, got=str(array.dtype))
    turned = array.astype(wanted)
    if array.dtype.kind == "f":
        # wider or narrower floats: NaN is left for the check that names it
        lost = (turned != array) & (array == array)
    else:
        # beyond 2^62 the conversion back could overflow
        lost = (turned.astype(array.dtype) != array) | (np.abs(turned) > 2.0**62)
    wrong = np.flatnonzero(lost)
    if wrong.size:
        item = f"{label}[{wrong[0]}]" if array.ndim else label
        got = str(array.reshape(-1)[wrong[0]])
        raise BadInput(f"no {np.dtype(wanted).name}", where=where, item=item, got=got)
    return turned[()]


@functools.cache
def compiled(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """The kernel as a function of arrays: one array for each scalar, vectors field by field.

    Columns are broadcast to one shape; the result has it too, and elements of type bool, int64 or
    float64 as the kernel's. `out` may be given for it; BadInput if it, or a column, does not fit.
    A kernel with a record as result gives that record of arrays, and `out` is a tuple of arrays.
    """
    returns = get_type_hints(kernel)["return"]
    if returns not in KINDS:
        return Reading(kernel, MACHINE, functools.partial(_records, program(kernel)))
    kind = KINDS[returns]
    try:
        source: Program | None = program(kernel)
    except NotInSubset:
        source = None
    if source is not None and source.divides:
        source = None  # a division is carried out only where the kernel carries it out

    def run(*columns: Any, out: np.ndarray | None = None) -> np.ndarray:
        if source is None:
            arrays = np.broadcast_arrays(*[np.asarray(column) for column in columns])
            shape = arrays[0].shape
            flat = [np.ascontiguousarray(array).reshape(-1) for array in arrays]
            found = outcome(kernel.__name__, out, shape, kind)
            _source_map(kernel)(found, *flat)
            return found.reshape(shape)
        flat, shape = checked(source, columns)
        found = outcome(source.name, out, shape, kind)
        _straight_map(source, single(source, flat))(found, *flat)
        return found.reshape(shape)

    return Reading(kernel, MACHINE, run)
