"""How a flight was flown, read from its command line."""

from __future__ import annotations

import shlex

IN_PROCESSES = ("--processes", "--simulator")


def flown_in_processes(command: str) -> bool:
    """Whether a command flies in several processes: in real time, with the gates in UxAS; also on an AMASE."""
    return any(word.partition("=")[0] in IN_PROCESSES for word in _words(command))


def with_original_clients(command: str) -> bool:
    """True if ICAROUS was flown behind its original clients, whose protocol has no heartbeats."""
    return flown_in_processes(command) and "--original-clients" in _words(command)


def _words(command: str) -> list[str]:
    """The words of a command line as a shell splits them, quotes respected."""
    try:
        return shlex.split(command)
    except ValueError:  # unbalanced quote: not written by a shell
        return command.split()
