"""How a flight was flown, as its command says."""

from __future__ import annotations

import shlex

IN_PROCESSES = ("--processes", "--simulator")


def flown_in_processes(command: str) -> bool:
    """Whether a command flies in processes: in real time, with the gates in UxAS. On an AMASE it does, too."""
    return any(word.partition("=")[0] in IN_PROCESSES for word in _words(command))


def with_original_clients(command: str) -> bool:
    """True if ICAROUS was flown behind the original's clients, whose protocol has no heartbeats."""
    return flown_in_processes(command) and "--original-clients" in _words(command)


def _words(command: str) -> list[str]:
    """The words of a command as a shell has them: a name with spaces in quotes is one."""
    try:
        return shlex.split(command)
    except ValueError:  # no shell has written it: a quote stands open
        return command.split()
