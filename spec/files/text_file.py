"""Reading files within bounds: as bytes, as text, or line by line, gzipped or not."""

from __future__ import annotations

import gzip
import stat
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from cratous.spec.errors import BadInput
from cratous.spec.files import limits


def bytes_of(file: Path, most: int = limits.DOCUMENT_BYTES, expected: str = "a file") -> bytes:
    """A file's bytes; raises BadInput if it is missing, not a regular file, unreadable or longer than `most`."""
    try:
        _check_regular(file, expected)
        with file.open("rb") as stream:
            data = stream.read(most + 1)
            if len(data) > most:
                raise BadInput(
                    "the file is too large", where=str(file), expected=f"at most {most} bytes"
                )
    except FileNotFoundError:
        raise BadInput("there is no such file", where=str(file), expected=expected) from None
    except (OSError, ValueError) as error:
        got = getattr(error, "strerror", None) or str(error)
        raise BadInput(
            f"the file cannot be read ({got})", where=str(file), expected=expected
        ) from None
    return data


def text_of(file: Path, most: int = limits.DOCUMENT_BYTES, expected: str = "a file") -> str:
    """A file's text in UTF-8; raises BadInput as `bytes_of`, or with the first byte that is not valid UTF-8."""
    try:
        return bytes_of(file, most, expected).decode("utf-8")
    except UnicodeDecodeError as error:
        raise BadInput(
            "not a text file", where=str(file), expected="UTF-8", got=f"byte {error.start} is not"
        ) from None


def lines_of(file: Path) -> Iterator[tuple[int, str]]:
    """(number, line) of each line of a text file, gzipped if its name ends in `.gz`; raises BadInput beyond a bound."""
    total, packed = 0, file.suffix == ".gz"
    try:
        _check_regular(file, "a file of text")
        with _opened(file, packed) as stream:
            for number, line in enumerate(
                iter(lambda: stream.readline(limits.LINE_BYTES + 1), b""), 1
            ):
                total += len(line)
                limits.at_most(
                    len(line), limits.LINE_BYTES, "a line is too long", f"{file}:{number}"
                )
                if packed:  # what is not inflated costs no more than the file is long
                    limits.at_most(total, limits.STREAM_BYTES, "too long unpacked", str(file))
                    limits.at_most(number, limits.LINES, "too many lines", str(file), "lines")
                try:
                    yield number, line.decode("utf-8")
                except UnicodeDecodeError as error:
                    raise BadInput(
                        "not a text file", where=f"{file}:{number}", expected="UTF-8",
                        got=f"byte {error.start} of the line is not",
                    ) from None  # fmt: skip
    except FileNotFoundError as error:
        raise BadInput("there is no such file", where=str(file)) from error
    except (OSError, EOFError, zlib.error) as error:
        raise BadInput(f"the file cannot be read: {error}", where=str(file)) from error


def _check_regular(file: Path, expected: str) -> None:
    """Raise BadInput for a pipe or a device, which could block its reader for ever."""
    mode = file.stat().st_mode
    if not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):  # of a folder the system says so itself
        raise BadInput("not a regular file", where=str(file), expected=expected)


def _opened(file: Path, packed: bool) -> IO[bytes]:
    return gzip.open(file, "rb") if packed else file.open("rb")  # type: ignore[return-value]
