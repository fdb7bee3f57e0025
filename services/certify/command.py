"""How a flight was flown, as its command says."""

from __future__ import annotations


def flown_in_processes(command: str) -> bool:
    """Whether a command flies in processes: in real time, with the gates in UxAS."""
    return "--processes" in command.split()


def with_original_clients(command: str) -> bool:
    """Whether ICAROUS is behind clients of the original's, whose protocol has no heartbeats."""
    return flown_in_processes(command) and "--original-clients" in command.split()
