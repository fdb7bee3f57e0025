"""Where an error was raised while a theorem was stated: in its file, in the code it is about, or in the prover."""

from __future__ import annotations

import traceback
from pathlib import Path

from cratous.core.kernel.sources import ROOT, place
from cratous.proofs.engine.theorem_files import FOLDER


def slip_in(error: BaseException, folder: Path) -> str:
    """The place in the theorem's file, or in a lemma's, that raised the error itself; empty if elsewhere."""
    frames = [] if error.__traceback__ is None else traceback.extract_tb(error.__traceback__)
    file = Path(frames[-1].filename) if frames else Path()
    if file.parent not in (folder, FOLDER):
        return ""
    return f"{place(file).partition(':')[0]}:{frames[-1].lineno}"


def raised_there(error: BaseException, folder: Path) -> bool:
    """Whether a kernel or definition raised the error itself, and not the prover or a library."""
    frames = [] if error.__traceback__ is None else traceback.extract_tb(error.__traceback__)
    above = Path(frames[-1].filename).resolve().parents if frames else ()
    homes = (folder.parent.resolve(), *(ROOT / part for part in ("spec", "core")))
    return any(home in above for home in homes) and ROOT / "proofs" not in above
