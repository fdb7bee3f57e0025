"""A document as one HTML page: nothing is loaded from elsewhere, every text is escaped."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

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
from cratous.spec.files.printable import printable


@cache
def _template() -> Any:
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    def source(name: str) -> str:
        folder = "certify" if name == "report.css" else "full_report"
        return files(f"cratous.services.{folder}").joinpath(name).read_text("utf-8")

    environment = Environment(
        autoescape=True, finalize=_shown, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
        loader=FunctionLoader(source),
    )  # fmt: skip
    kinds = {Words: "words", Head: "head", Table: "table", Picture: "picture", Beside: "beside",
             Line: "line", Disc: "disc", Label: "label"}  # fmt: skip
    environment.filters["kind"] = lambda part: kinds[type(part)]
    environment.filters["ink"] = _ink
    return environment.get_template("full.html")


def _shown(value: Any) -> Any:
    return printable(value, keep="\n\t") if type(value) is str else value


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
