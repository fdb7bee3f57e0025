"""Tries cases of the self-test for tests: pickled cases come in, pickled trials go out.

Each case is tried in forked processes. Forked from the process of all tests they would cost more than
the trials do: every page of its tables is copied.
"""

from __future__ import annotations

import contextlib
import pickle
import sys

from cratous.proofs.self_test import trial


def main() -> None:
    trial.prepare()
    with contextlib.suppress(EOFError):
        while True:
            pickle.dump(trial.attempt(pickle.load(sys.stdin.buffer)), sys.stdout.buffer)
            sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
