"""Writes the table of ICAROUS's parameters into `docs/reference/parameters.md`."""

from __future__ import annotations

from pathlib import Path

from cratous.core.files.whole_file import write_atomically
from cratous.services.parameters.icarous_names import NAMES

PAGE = Path(__file__).resolve().parents[1] / "reference" / "parameters.md"
HEAD = "| name | default | here |\n|---|---|---|\n"


def main() -> None:
    """Rewrite everything after the head of the table."""
    rows = []
    for name in NAMES.values():
        used = f"sets `{name.item}`" if name.item else "not used"
        why = f": {name.why}" if name.why else ""
        rows.append(f"| `{name.name}` | {f'{name.default} {name.unit}'.strip()} | {used}{why} |\n")
    text = PAGE.read_text(encoding="utf-8").partition(HEAD)[0]
    write_atomically(PAGE, text + HEAD + "".join(rows))


if __name__ == "__main__":
    main()
