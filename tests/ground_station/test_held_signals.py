"""A signal that comes while a process is copied ends it afterwards, and is not dropped."""

from __future__ import annotations

import os
import subprocess
import sys

# a callback of a fork, as Python's logging has one: what a handler raises there is dropped
CHILD = """
import os, signal, sys
from cratous.services.cli.stopping import Stopped, stoppable
from cratous.services.ground_station.deferred_signals import held_back
os.register_at_fork(before=lambda: os.kill(os.getpid(), signal.SIGTERM))
with stoppable():
    with held_back():
        child = os.fork()
    if child:
        os.waitpid(child, 0)
print("it was dropped")
"""


def test_it_waits_for_the_end_of_the_copying() -> None:
    done = subprocess.run(
        [sys.executable, "-c", CHILD],
        capture_output=True, text=True, timeout=60, env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    assert (done.returncode, done.stdout, done.stderr) == (143, "", "")
