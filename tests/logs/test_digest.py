"""The digest's short way for messages without an envelope gives what its definition gives."""

from __future__ import annotations

import hashlib

from hypothesis import given
from hypothesis import strategies as st

from cratous.services.logs.entry import Entry
from cratous.services.logs.records import canonical
from cratous.services.logs.schema import Digest

WORDS = st.text(st.characters(codec="utf-8"), max_size=8)
ENTRIES = st.builds(
    Entry, st.integers(0, 2**63), st.integers(-(2**63), 2**63), WORDS, WORDS,
    st.one_of(WORDS, st.binary(max_size=8)), st.one_of(st.none(), WORDS), st.one_of(st.none(), WORDS),
)  # fmt: skip


@given(st.lists(ENTRIES, max_size=6))
def test_the_digest_is_of_head_and_body_line_by_line(entries: list[Entry]) -> None:
    digest, expected = Digest(), b""
    for entry in entries:
        digest.feed(entry)
        outside = entry[5:]
        head = [*entry[:4], *(outside if any(v is not None for v in outside) else ())]
        body = entry.body if isinstance(entry.body, bytes) else entry.body.encode()
        expected += canonical(head).encode() + b"\n" + body + b"\n"
    assert digest.hex() == hashlib.sha256(expected).hexdigest()
