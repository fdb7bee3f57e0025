"""Writes the files generated from the models: the stubs of the classes and the JSON Schema.

    python -m cratous.bridge.lmcp.generate [--check]

`--check` writes nothing and fails if a file differs from what it would write.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import cratous.spec
from cratous.bridge.lmcp import model, schema, stubs
from cratous.core.files.whole_file import write_atomically

MESSAGES = Path(__file__).resolve().parent / "messages"
SCHEMA = Path(cratous.spec.__path__[0]).resolve() / "lmcp" / "lmcp.schema.json"


def files() -> dict[Path, str]:
    """The text of every generated file."""
    found = {MESSAGES / f"{s.lower()}.pyi": stubs.stub(s) for s in model.SERIES}
    found[SCHEMA] = json.dumps(schema.schema(), ensure_ascii=False, separators=(",", ":")) + "\n"
    found[SCHEMA] = found[SCHEMA].replace('},"', '},\n"')  # for readable diffs
    return found


def main(check: bool) -> int:
    """Write or check all files; returns the exit code."""
    stale = [f for f, text in files().items() if not f.is_file() or f.read_text("utf-8") != text]
    for file in stale:
        if check:
            print(f"{file.name}: not up to date, run `make docs`")
        else:
            write_atomically(file, files()[file])
    return int(check and bool(stale))


if __name__ == "__main__":
    sys.exit(main("--check" in sys.argv))
