"""The judge: whether a logged flight satisfied G1 to G5. A stand-alone program.

It shares no code with planner, pilot, monitor, kernels or definitions: it reads the SQLite file and
the mission in it (or a mission file), and decides by its own geometry, its own parser of the
process algebra, and its own definitions. From CRATOUS it imports only `cratous.spec.errors`. See
docs/guides/judge.md.
"""

if __name__ != "cratous.judge":
    raise ImportError(f"import this package as 'cratous.judge', not as {__name__!r}")

from cratous.judge.flight import Judgement, judge

__all__ = ["Judgement", "judge"]
