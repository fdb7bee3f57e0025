"""Writes the text of an imported mission file, and checks that it can be read."""

from __future__ import annotations

from collections.abc import Sequence

from cratous.services.importing.composing import Composed
from cratous.services.loading.document import parse_document
from cratous.services.loading.yaml_mission import loaded
from cratous.spec.files.printable import printable


def mission_text(made: Composed, names: Sequence[str]) -> str:
    """YAML, with decisions and omissions as comments at the top."""
    import yaml

    head = [f"Made by `cratous import` of {', '.join(names)}.", *made.notes]
    said = "".join(f"# {printable(line)}\n" for line in head)
    body = yaml.safe_dump(
        made.data, sort_keys=False, default_flow_style=None, allow_unicode=True, width=100
    )
    return said + body


def checked(text: str, where: str) -> tuple[str, ...]:
    """Read the text as `cratous run` will. Returns the mission's notes; raises BadInput."""
    return loaded(parse_document(text, where)).notes
