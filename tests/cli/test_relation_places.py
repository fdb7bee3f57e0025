"""Where a text that a reason quotes stands in the mission's file."""

from __future__ import annotations

from pathlib import Path

from cratous.services.cli.relation_places import RelationPlaces
from cratous.services.loading import load


def test_a_comment_with_the_same_text_is_not_its_place(tmp_path: Path, root: Path) -> None:
    text = (root / "examples" / "relations" / "mission.yaml").read_text()
    (number,) = (k for k, line in enumerate(text.splitlines(), 1) if line.startswith("relations:"))
    file = tmp_path / "mission.yaml"
    file.write_text("# in words: .(p1 p2)\n" + text)
    places = RelationPlaces(load(file))
    assert places.told("because of `.(p1 p2)`") == f"because of `.(p1 p2)` at {file}:{number + 1}"
    assert places.told("as `Surveyor` says") == "as `Surveyor` says"
