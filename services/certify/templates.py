"""Jinja2 set-up for the pages: every text is escaped, and compiled templates are cached between runs."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from cratous.core.files.private_cache import private_cache
from cratous.core.kernel.sources import digest
from cratous.spec.errors import BadInput
from cratous.spec.files.printable import printable

KEPT = "pages"
"""Name of the cache folder."""


def environment(source: Callable[[str], str]) -> Any:
    """The jinja2 environment for pages; `source` returns a template by name."""
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    return Environment(
        autoescape=True, finalize=_shown, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
        loader=FunctionLoader(source), bytecode_cache=_kept(),
    )  # fmt: skip


def _shown(value: Any) -> Any:
    """The text that a page shows for a value; markup is left unchanged."""
    return printable(value, keep="\n\t") if type(value) is str else value


def _kept() -> Any:
    """Jinja2's bytecode cache, keyed by the hash of the template; None if nothing can be cached.

    The folder depends on the version of jinja2 and on this file, whose settings enter the compiled
    code.
    """
    import jinja2
    from jinja2.bccache import Bucket, FileSystemBytecodeCache

    class Kept(FileSystemBytecodeCache):
        def dump_bytecode(self, bucket: Bucket) -> None:
            with contextlib.suppress(OSError):  # an unwritable cache is no error
                super().dump_bytecode(bucket)

    made_by = digest([jinja2.__version__, Path(__file__).read_text(encoding="utf-8")])
    with contextlib.suppress(OSError, BadInput):
        folder = private_cache() / KEPT / made_by[:32]
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        return Kept(str(folder))
    return None
