"""The judge: did a logged flight keep G1 to G5? A program of its own.

It shares no code with planner, pilot, monitor, kernels or definitions: it reads the SQLite file and
the mission in it (or a mission file), and decides by its own geometry, its own reading of the process
algebra, and its own definitions. Of ours it imports `cratous.spec.errors` alone. See docs/guides/judge.md.
"""

if __name__ != "cratous.judge":
    raise ImportError(f"import this package as 'cratous.judge', not as {__name__!r}")

from cratous.judge.flight import Judgement, judge

__all__ = ["Judgement", "judge"]
