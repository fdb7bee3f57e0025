"""Draws a picture as vectors with reportlab, with its caption below."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cratous.services.full_report.document import Picture
from cratous.services.full_report.shapes import (
    FONT_SIZE,
    RULE,
    SOFT,
    STYLES,
    TEXT,
    Disc,
    Label,
    Line,
)

TITLE, KEY, SIZE = 12.0, 9.5, 6.6
FONT = "Helvetica"


def needed() -> None:
    """Raise ModuleNotFoundError if reportlab is not installed."""
    import reportlab.platypus  # noqa: F401


def drawing(picture: Picture, width: float, shown: Callable[[object], str]) -> Any:
    """The picture `width` points wide. shown: maps a text to the characters of the font."""
    from reportlab.pdfbase.pdfmetrics import stringWidth
    from reportlab.platypus import Flowable

    factor = width / picture.width
    high = picture.height * factor
    lines: list[list[tuple[float, str, str]]] = [[]]
    x = 0.0
    for text, style in picture.caption:
        said = shown(text)
        wide = 22.0 + stringWidth(said, FONT, SIZE) + 8.0
        if lines[-1] and x + wide > width:
            lines.append([])
            x = 0.0
        lines[-1].append((x, said, style))
        x += wide
    below = KEY * len(lines)

    class Drawn(Flowable):
        def wrap(self, _width: float, _height: float) -> tuple[float, float]:
            return width, TITLE + high + below + 2

        def draw(self) -> None:
            canvas = self.canv
            canvas.setFillColor(TEXT)
            canvas.setFont("Helvetica-Bold", 7.2)
            canvas.drawString(2, high + below + 5, shown(picture.title))
            canvas.saveState()
            canvas.translate(0, below + 2)
            canvas.setStrokeColor(RULE)
            frame = canvas.beginPath()
            frame.rect(0, 0, width, high)
            canvas.clipPath(frame, stroke=1, fill=0)
            canvas.translate(0, high)
            canvas.scale(factor, factor)
            for shape in picture.shapes:
                _draw(canvas, shape, shown)
            canvas.restoreState()
            for number, line in enumerate(lines):
                y = below - KEY * (number + 1) + 3
                for at, said, style in line:
                    _key(canvas, (at + 2, y), style)
                    canvas.setFillColor(SOFT)
                    canvas.setFont(FONT, SIZE)
                    canvas.drawString(at + 22, y, said)

    return Drawn()


def _key(canvas: Any, at: tuple[float, float], style: str) -> None:
    """A sample of the line or area that a caption text explains."""
    canvas.saveState()
    canvas.translate(at[0], at[1] + 2)
    canvas.scale(0.5, 0.5)
    if style == "takeover":
        _draw(canvas, Disc((16.0, 0.0), 5.0, style), str)
    elif STYLES[style].fill:
        _draw(canvas, Line(((0.0, -4.0), (32.0, -4.0), (32.0, 4.0), (0.0, 4.0)), style, True), str)
    else:
        _draw(canvas, Line(((0.0, 0.0), (32.0, 0.0)), style), str)
    canvas.restoreState()


def _draw(canvas: Any, shape: Line | Disc | Label, shown: Callable[[object], str]) -> None:
    """Draw a shape; y of shapes grows downwards."""
    if isinstance(shape, Label):
        canvas.setFillColor(SOFT if shape.soft else TEXT, alpha=1.0)
        canvas.setFont(FONT, FONT_SIZE)
        ways = {"start": canvas.drawString, "middle": canvas.drawCentredString, "end": canvas.drawRightString}  # fmt: skip
        ways[shape.anchor](shape.at[0], -shape.at[1], shown(shape.text))
        return
    ink = STYLES[shape.style]
    canvas.saveState()
    if ink.stroke:
        canvas.setStrokeColor(ink.stroke, alpha=ink.stroke_opacity)
    if ink.fill:
        canvas.setFillColor(ink.fill, alpha=ink.fill_opacity)
    canvas.setLineWidth(ink.width)
    canvas.setLineCap(1 if ink.round_ends else 0)
    canvas.setLineJoin(1 if ink.round_ends else 0)
    canvas.setDash(list(ink.dash))
    stroke, fill = int(bool(ink.stroke)), int(bool(ink.fill))
    if isinstance(shape, Disc):
        canvas.circle(shape.at[0], -shape.at[1], shape.radius, stroke=stroke, fill=fill)
    elif shape.places:
        path = canvas.beginPath()
        path.moveTo(shape.places[0][0], -shape.places[0][1])
        for x, y in shape.places[1:]:
            path.lineTo(x, -y)
        if shape.closed:
            path.close()
        canvas.drawPath(path, stroke=stroke, fill=fill)
    canvas.restoreState()
