"""A document as one HTML page: no external resources, every text escaped."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

from cratous.services.certify import templates
from cratous.services.full_report.document import (
    VERDICTS,
    Beside,
    Document,
    Head,
    Picture,
    Table,
    Words,
)
from cratous.services.full_report.shapes import (
    FONT_SIZE,
    SOFT,
    STYLES,
    TEXT,
    Disc,
    Ink,
    Label,
    Line,
)


@cache
def _template() -> Any:
    def source(name: str) -> str:
        folder = "certify" if name == "report.css" else "full_report"
        return files(f"cratous.services.{folder}").joinpath(name).read_text("utf-8")

    environment = templates.environment(source)
    kinds = {Words: "words", Head: "head", Table: "table", Picture: "picture", Beside: "beside",
             Line: "line", Disc: "disc", Label: "label"}  # fmt: skip
    environment.filters["kind"] = lambda part: kinds[type(part)]
    environment.filters["ink"] = _ink
    return environment.get_template("full.html")


def _ink(style: str) -> str:
    one: Ink = STYLES[style]
    said = f"stroke:{one.stroke or 'none'};fill:{one.fill or 'none'};stroke-width:{one.width:g};"
    said += f"stroke-opacity:{one.stroke_opacity:g};fill-opacity:{one.fill_opacity:g};"
    said += f"stroke-dasharray:{' '.join(f'{d:g}' for d in one.dash)};" if one.dash else ""
    return said + ("stroke-linecap:round;stroke-linejoin:round;" if one.round_ends else "")


def html(pages: Document) -> str:
    """The text of the page."""
    text: str = _template().render(
        d=pages, verdicts=VERDICTS, size=FONT_SIZE, inks={"text": TEXT, "soft": SOFT}
    )
    return text
