"""Campaigns that are searched in tests."""

from __future__ import annotations

from pathlib import Path

from cratous.services.cli import main


def loss_found(folder: Path, text: str) -> Path:
    """Where the results are of a search for a loss of well clear, by one run; it has to find one."""
    file, out = folder / "campaign.yaml", folder / "out"
    file.write_text(text)
    arguments = ["--find", "G2", "--budget", "1", "--allow-unproved", "-o", str(out)]
    assert main(["campaign", str(file), *arguments]) == 1
    return out
