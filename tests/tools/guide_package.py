"""The package with a kernel of its own that `docs/guides/own-kernel.md` has, as files."""

from __future__ import annotations

import re
from pathlib import Path

FILE = re.compile(r"^`([\w/]+\.py)`\n```python\n(.*?)^```", re.S | re.M)


def written(root: Path, folder: Path) -> Path:
    """The page's files, in an empty folder outside of the repository."""
    text = (root / "docs" / "guides" / "own-kernel.md").read_text(encoding="utf-8")
    for name, body in FILE.findall(text):
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(body, encoding="utf-8")
    return folder
