"""How the templates of pages are read: every text is escaped, and what they compile to is kept from run to run."""

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
"""The folder of the cache."""


def environment(source: Callable[[str], str]) -> Any:
    """The templates that `source` gives by name, as jinja2 reads them for a page."""
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    return Environment(
        autoescape=True, finalize=_shown, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
        loader=FunctionLoader(source), bytecode_cache=_kept(),
    )  # fmt: skip


def _shown(value: Any) -> Any:
    """What a page shows of a value; what is a page already stays as it is."""
    return printable(value, keep="\n\t") if type(value) is str else value


def _kept() -> Any:
    """Where jinja2 keeps compiled templates, by the hash of their text; None where nothing can be kept.

    The folder is that of this version of jinja2 and of this file, for its settings are in what is compiled.
    """
    import jinja2
    from jinja2.bccache import Bucket, FileSystemBytecodeCache

    class Kept(FileSystemBytecodeCache):
        def dump_bytecode(self, bucket: Bucket) -> None:
            with contextlib.suppress(OSError):  # a folder that cannot be written is no error
                super().dump_bytecode(bucket)

    made_by = digest([jinja2.__version__, Path(__file__).read_text(encoding="utf-8")])
    with contextlib.suppress(OSError, BadInput):
        folder = private_cache() / KEPT / made_by[:32]
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        return Kept(str(folder))
    return None
