"""cvc5 as an independent solver: it is given SMT-LIB text only, in a process of its own."""

from __future__ import annotations

import multiprocessing
import resource
import signal
import time
from multiprocessing.connection import Connection
from typing import Any

from cratous.proofs.engine.cpu_limit import of_the_user, what_ended

CPU_SECONDS = 5


class Stopped(RuntimeError):
    """The answering process was ended by something other than CPU_SECONDS."""


Way = tuple[str, dict[str, str]]
"""A configuration: the logic, and options."""


def solve(text: str, logic: str, options: dict[str, str] | None = None) -> str:
    """sat, unsat or unknown, by cvc5 on SMT-LIB text under the given logic.

    Raises ValueError for text that cvc5 refuses.
    """
    import cvc5

    # terms of its own, so that the answer depends on the text alone
    solver = cvc5.Solver(cvc5.TermManager())
    for option, value in (options or {}).items():
        solver.setOption(option, value)
    parser = cvc5.InputParser(solver)
    body = "\n".join(line for line in text.splitlines() if not line.startswith("(set-logic"))
    solver.setLogic(logic)
    parser.setStringInput(cvc5.InputLanguage.SMT_LIB_2_6, body, "obligation")
    symbols = parser.getSymbolManager()
    answer = "unknown"
    while True:
        command = parser.nextCommand()
        if command.isNull():
            return answer
        if command.getCommandName() == "set-info":
            # the expected status is for readers; the solver does not get it
            continue
        said = str(command.invoke(solver, symbols)).strip()
        if said in ("sat", "unsat", "unknown"):
            answer = said
        elif said.startswith("(error"):
            raise ValueError(said)


def _answer(questions: Connection, asking: Connection) -> None:
    """Answer questions until the connection closes; the system ends this process when a question takes too long."""
    asking.close()  # close this copy of the other end, so that only the asking process holds it open
    while True:
        try:
            text, way = questions.recv()
        except EOFError:
            return
        used = time.process_time()
        _, most = resource.getrlimit(resource.RLIMIT_CPU)
        latest = int(used) + CPU_SECONDS
        soft = latest if most == resource.RLIM_INFINITY else min(latest, most)
        resource.setrlimit(resource.RLIMIT_CPU, (soft, most))
        questions.send((solve(text, *way), time.process_time() - used))


class Asker:
    """Puts questions to cvc5 one after the other; a process that was ended is restarted for the next."""

    def __init__(self) -> None:
        self._pipe: Connection | None = None
        self._process: Any = None

    def ask(self, text: str, way: Way, *, again: bool = True) -> tuple[str, float]:
        """sat, unsat or unknown, and the CPU seconds used.

        Raises Stopped where something other than CPU_SECONDS ended the question.
        """
        if self._pipe is None:
            fork = multiprocessing.get_context("fork")
            self._pipe, there = fork.Pipe()
            self._process = fork.Process(target=_answer, args=(there, self._pipe), daemon=True)
            self._process.start()
            there.close()
        try:
            self._pipe.send((text, way))
            answer: tuple[str, float] = self._pipe.recv()
        except (EOFError, OSError):
            code = self.end()
            if code == -signal.SIGKILL and again:
                # the limit covers all of its questions together: a new process starts from zero
                return self.ask(text, way, again=False)
            if code == -signal.SIGKILL or of_the_user() < CPU_SECONDS:
                raise Stopped(what_ended(code, CPU_SECONDS)) from None
            return "unknown", float(CPU_SECONDS)
        return answer

    def end(self) -> int | None:
        """Stop the process that answers; returns its exit code."""
        if self._pipe is None:
            return None
        self._pipe.close()
        self._process.join()
        self._pipe = None
        code: int | None = self._process.exitcode
        return code
