"""Text that can stand unchanged in YAML and XML: characters that either refuses are escaped."""

from __future__ import annotations

import re

from cratous.spec.files.printable import printable

REFUSED = re.compile("[^\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def plain_text(text: object) -> str:
    r"""The text with every character escaped that YAML or XML cannot contain.

    >>> plain_text("ok\n\ufffe")
    'ok\\n\\ufffe'
    """
    return REFUSED.sub(lambda c: c[0].encode("unicode_escape").decode("ascii"), printable(text))
