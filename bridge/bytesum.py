"""The checksum of LMCP messages and of sentinel frames: the plain sum of the bytes, modulo 2^32.

CPython adds bytes one object at a time. The lower half of Adler-32, started at 0, is the same sum modulo 65521, which
256 bytes cannot reach: so pieces of 256 bytes are summed in C, exactly.
"""

from __future__ import annotations

from zlib import adler32

_PIECE = 256  # 256 * 255 = 65280 < 65521
_MASK = 0xFFFFFFFF


def byte_sum(data: bytes | bytearray | memoryview) -> int:
    """Sum of all bytes modulo 2^32.

    >>> byte_sum(b"LMCP"), byte_sum(bytes([255]) * 100_000)
    (300, 25500000)
    """
    size = len(data)
    if size <= _PIECE:
        return adler32(data, 0) & 0xFFFF
    view = memoryview(data)
    total = 0
    for at in range(0, size, _PIECE):
        total += adler32(view[at : at + _PIECE], 0) & 0xFFFF
    return total & _MASK
