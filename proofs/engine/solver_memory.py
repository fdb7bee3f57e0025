"""Memory of the solver, kept by the process that has asked.

Every question has a context of its own, and each begins with a table of 16 MB. What an earlier one has
given back is used for the next; else the system clears thousands of pages for each. Answers are the same.
"""

from __future__ import annotations

import ctypes
import functools
import sys

TRIM, TOP_PAD, MMAP = -1, -2, -3
"""Settings of the C library's allocator (glibc's malloc.h): what is returned, taken at once, mapped."""
HUGE_PAGES = 14
"""Advice to the system (Linux, mman.h)."""
MB = 2**20


@functools.cache
def keep() -> None:
    """From now on this process, and those forked from it, keep what the solver frees.

    Nothing is done where the C library is another one.
    """
    library = ctypes.CDLL(None) if sys.platform == "linux" else None
    if not hasattr(library, "mallopt") or not hasattr(library, "gnu_get_libc_version"):
        return
    assert library is not None
    library.malloc.restype, library.malloc.argtypes = ctypes.c_void_p, [ctypes.c_size_t]
    library.free.argtypes = [ctypes.c_void_p]
    library.madvise.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int]
    library.mallopt(MMAP, 32 * MB)
    library.mallopt(TRIM, 512 * MB)
    # room that nobody has touched: whoever does takes it in large pages
    library.mallopt(TOP_PAD, 64 * MB)
    room = library.malloc(24 * MB)
    library.free(room)
    library.mallopt(TOP_PAD, MB)
    if room:
        start = -(-room // (2 * MB)) * 2 * MB
        library.madvise(start, 80 * MB, HUGE_PAGES)  # refused where it is not all there
