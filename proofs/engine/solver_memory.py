"""Makes the process keep memory that the solver frees.

Every question has a context of its own, and each starts by allocating a table of 16 MB. Freed memory is reused for
the next; otherwise the system would clear thousands of pages for each question. Answers do not depend on it.
"""

from __future__ import annotations

import ctypes
import functools
import sys

TRIM, TOP_PAD, MMAP = -1, -2, -3
"""Parameters of the allocator (glibc's malloc.h): trim threshold, top padding, mmap threshold."""
HUGE_PAGES = 14
"""MADV_HUGEPAGE: advice to use large pages (Linux, mman.h)."""
MB = 2**20


@functools.cache
def keep() -> None:
    """From now on this process, and those forked from it, keep what the solver frees.

    Does nothing with another C library than glibc.
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
    # memory not touched so far: the first access takes it in large pages
    library.mallopt(TOP_PAD, 64 * MB)
    room = library.malloc(24 * MB)
    library.free(room)
    library.mallopt(TOP_PAD, MB)
    if room:
        start = -(-room // (2 * MB)) * 2 * MB
        library.madvise(start, 80 * MB, HUGE_PAGES)  # fails if not all is mapped
