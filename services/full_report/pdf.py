"""A document as PDF, by reportlab: the same document gives the same bytes.

Nothing is compressed, since compression libraries differ in their output, and there is no time
stamp. The fonts are those that every reader has; characters missing in them are written as their
code.
"""

from __future__ import annotations

from io import BytesIO
from typing import Any
from xml.sax.saxutils import escape

from cratous.services.full_report.document import (
    VERDICTS,
    Beside,
    Document,
    Head,
    Part,
    Picture,
    Table,
    Words,
)
from cratous.services.full_report.pdf_drawing import drawing
from cratous.services.full_report.shapes import BAD, GOOD, RULE, SOFT, TEXT
from cratous.spec.files.printable import printable

WIDTH, HEIGHT, EDGE, FOOT = 595.28, 841.89, 34.0, 30.0
ROOM = WIDTH - 2 * EDGE - 12  # a reportlab frame has 6 points of padding on each side
HIGH = HEIGHT - 160.0
"""Maximum height of a row that fits on a page below the head of its table [points]."""
OWN_PAGES = 2
COLOURS = {"holds": GOOD, "violated": BAD, "unknown": "#9a6700", "excused": "#9a6700"}
PLAIN = {"→": "->", "≤": "<=", "≥": ">=", "−": "-", "≠": "!="}


def shown(text: object) -> str:
    """A text in the characters of the fonts; others as their code."""
    said = printable(text, keep="\n")
    for sign, plain in PLAIN.items():
        said = said.replace(sign, plain)
    return said.encode("cp1252", "backslashreplace").decode("cp1252")


def pdf(pages: Document) -> bytes:
    """The bytes of the file. NotInstalled where the extra `pdf` is missing (`spec.files.extras.told`)."""
    from reportlab.lib.styles import ParagraphStyle
    from reportlab.platypus import CondPageBreak, PageBreak, Paragraph, SimpleDocTemplate, Spacer

    make = _Maker(ParagraphStyle)
    story: list[Any] = [Paragraph(_line(pages.title), make.title), Paragraph(_line(pages.about), make.soft)]  # fmt: skip
    for number, section in enumerate(pages.sections):
        if number:
            # the first two start on new pages; later ones wherever there is room
            story += [PageBreak()] if number < OWN_PAGES else [Spacer(1, 12), CondPageBreak(150)]
            story.append(Paragraph(_line(section.title), make.section))
        for part in section.parts:
            story += make.flowables(part)
    stream = BytesIO()
    template = SimpleDocTemplate(
        stream, pagesize=(WIDTH, HEIGHT), leftMargin=EDGE, rightMargin=EDGE, topMargin=28, bottomMargin=FOOT,
        title=shown(pages.title), author="CRATOUS", invariant=1, pageCompression=0,
    )  # fmt: skip

    def footer(canvas: Any, page: Any) -> None:
        canvas.setFont("Helvetica", 6.5)
        canvas.setFillColor(SOFT)
        canvas.drawString(
            EDGE, 18, shown(pages.title)[:60] + ": evidence, not certification credit"
        )
        canvas.drawRightString(WIDTH - EDGE, 18, f"page {page.page}")

    template.build(story, onFirstPage=footer, onLaterPages=footer)
    return stream.getvalue()


def _line(text: object) -> str:
    return escape(shown(text)).replace("\n", "<br/>")


class _Maker:
    """Converts parts of a document to reportlab flowables."""

    def __init__(self, style: Any) -> None:
        def of(name: str, size: float, colour: str = TEXT, **more: Any) -> Any:
            return style(
                name, fontName=more.pop("font", "Helvetica"), fontSize=size, leading=size * 1.25,
                textColor=colour, **more,
            )  # fmt: skip

        self.title = of("title", 16, font="Helvetica-Bold", spaceAfter=3)
        self.section = of("section", 13, font="Helvetica-Bold", spaceAfter=4)
        self.head = of("head", 9.5, font="Helvetica-Bold", spaceBefore=7, spaceAfter=2)  # fmt: skip
        self.cell, self.number = of("cell", 7.2), of("number", 7.2, alignment=2)
        self.column = of("column", 7.2, SOFT, font="Helvetica-Bold")
        self.column_number = of("columns", 7.2, SOFT, font="Helvetica-Bold", alignment=2)
        self.soft = of("soft", 7.2, SOFT, spaceAfter=3)
        self.kinds = {
            "text": of("text", 8, spaceAfter=3), "soft": self.soft,
            "code": of("code", 7.2, font="Courier", spaceAfter=3),
            "item": of("item", 7.2, leftIndent=8, bulletIndent=0, spaceAfter=1),
            "alarm": of("alarm", 8.5, BAD, font="Helvetica-Bold", borderColor=BAD, borderWidth=1,
                        borderPadding=4, spaceBefore=6, spaceAfter=8),
        }  # fmt: skip
        for verdict, colour in COLOURS.items():
            self.kinds[verdict] = of(
                verdict, 9, colour, font="Helvetica-Bold", borderColor=colour, borderWidth=1.2,
                borderPadding=5, spaceBefore=8, spaceAfter=10,
            )  # fmt: skip

    def flowables(self, part: Part) -> list[Any]:
        """The flowables of one part."""
        from reportlab.platypus import CondPageBreak, Paragraph, Spacer

        if isinstance(part, Words):
            bullet = "•" if part.kind == "item" else None
            return [Paragraph(_line(part.text), self.kinds[part.kind], bulletText=bullet)]
        if isinstance(part, Head):
            return [CondPageBreak(60), Paragraph(_line(part.text), self.head)]
        if isinstance(part, Picture):
            return [drawing(part, ROOM, shown), Spacer(1, 4)]
        if isinstance(part, Beside):
            return [self._beside(part), Spacer(1, 4)]
        return self._table(part)

    def _beside(self, part: Beside) -> Any:
        from reportlab.platypus import Spacer
        from reportlab.platypus import Table as Grid

        if not part.right:
            return drawing(part.left, min(ROOM, ROOM * 0.75), shown)
        left, right = ROOM * 0.58, ROOM * 0.41
        charts: list[Any] = []
        for one in part.right:
            charts += [drawing(one, right, shown), Spacer(1, 4)]
        grid = Grid(
            [[drawing(part.left, left, shown), charts]], colWidths=[left + ROOM * 0.01, right]
        )
        grid.setStyle([("VALIGN", (0, 0), (-1, -1), "TOP"), *_padding(0)])
        return grid

    def _table(self, part: Table) -> list[Any]:
        from reportlab.platypus import LongTable, Paragraph

        if not part.rows:
            return [Paragraph(_line(part.empty), self.soft)]
        whole = sum(part.shares)
        head = [
            Paragraph(_line(text), self.column_number if k in part.numbers else self.column)
            for k, text in enumerate(part.head)
        ]
        rows = [
            [Paragraph(_cell(text), self.number if k in part.numbers else self.cell) for k, text in enumerate(row)]
            for row in part.rows
        ]  # fmt: skip
        widths = [ROOM * share / whole for share in part.shares]
        # only rows higher than a page are split, with the head repeated above the rest
        tall = any(
            cell.wrap(width, HIGH)[1] > HIGH
            for row in rows
            for cell, width in zip(row, widths, strict=True)
        )
        table = LongTable(
            [head, *rows], colWidths=widths, repeatRows=1, splitByRow=1, splitInRow=int(tall), hAlign="LEFT",
        )  # fmt: skip
        style = [("VALIGN", (0, 0), (-1, -1), "TOP"), ("LINEBELOW", (0, 0), (-1, -1), 0.4, RULE)]
        style += [("RIGHTPADDING", (k, 0), (k, -1), 9) for k in part.numbers]
        table.setStyle([*_padding(2), *style])
        return [table]


def _padding(size: float) -> list[Any]:
    whole = (0, 0), (-1, -1)
    return [("LEFTPADDING", *whole, 0), ("RIGHTPADDING", *whole, 2 * size),
            ("TOPPADDING", *whole, size), ("BOTTOMPADDING", *whole, size)]  # fmt: skip


def _cell(text: str) -> str:
    first, *more = text.split("\n")
    said = _line(first)
    if first in VERDICTS:
        said = f'<font color="{COLOURS[VERDICTS[first]]}"><b>{said}</b></font>'
    soft = "".join(f'<br/><font color="{SOFT}" size="6.6">{_line(line)}</font>' for line in more)
    return said + soft
