"""Reading the text files that the definitions of formats begin with."""

from __future__ import annotations

from pathlib import Path

from cratous.spec.errors import BadInput


def text_of(file: Path) -> str:
    """A file's text in UTF-8; BadInput if it is missing or cannot be read."""
    try:
        return file.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise BadInput("there is no such file", where=str(file)) from error
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"the file cannot be read: {error}", where=str(file)) from error
