"""`cratous prove --scheduler`: theorems proved by workers of a cluster, whose answers are not trusted."""

from __future__ import annotations

import hashlib
import sys
from collections import deque
from pathlib import Path
from typing import Any

import click

from cratous.services.cli.progress import Bar
from cratous.services.cli.stopping import heed
from cratous.spec.errors import BadInput, CratousError

FUNCTION = "cratous.services.cli.prove_elsewhere:answered"
MEMORY_MB, TIME_S, ATTEMPTS = 8_000, 7_200, 2
"""Limits of a theorem on a worker, and the number of attempts if workers are lost."""


def refuse_what_vouches(whole: bool, others: dict[str, Any]) -> None:
    """BadInput for options that need every theorem proved here, where some may be proved elsewhere
    only.

    others: options by name. recheck and mutate are not supported by workers.
    """
    never = {"--recheck", "--mutate", "--self-test"}
    for name, given in others.items():
        if given and (name in never or not whole):
            raise BadInput(
                f"--scheduler does not go with {name}{'' if name in never else ' of a part'}",
                item="cratous prove", expected="one of them",
            )  # fmt: skip


def version(home: Any) -> str:
    """Digest of the files on which proofs of this home depend, and of the installed versions."""
    from cratous.proofs.elsewhere import sources
    from cratous.services.campaign.identity import version_digest

    sha = hashlib.sha256(version_digest().encode())
    for file in sources(home):
        data = file.read_bytes()
        sha.update(f"{file.name} {len(data)}\n".encode() + data)
    return sha.hexdigest()


def answered(task: dict[str, Any]) -> dict[str, Any]:
    """A worker's answer on a theorem: `proved` and `answers`, or `other version`, or why it is not `stated`."""
    from cratous.core import ledger as gate
    from cratous.core.files.private_cache import private_cache
    from cratous.proofs import elsewhere

    if task["package"] != "cratous" and str(Path.cwd()) not in sys.path:
        sys.path.insert(0, str(Path.cwd()))
    try:
        home = gate.package(task["package"])
        found = version(home)
        if found != task["version"]:
            return {"other version": found}
        gate.load_all()
        gate.load_all(home)
        return elsewhere.answered(task["theorem"], home, private_cache() / "proofs")
    except CratousError as error:
        return {"not stated": str(error)}


def ask(
    names: list[str], home: Any, scheduler: str, *, whole: bool, jobs: int, quiet: bool
) -> list[str]:
    """Have workers prove these theorems, and report their answers; returns those proved elsewhere
    only.

    whole: all are proved here anyway, so the result is empty. Raises Refused for workers of another
    version, BadInput if there is no scheduler.
    """
    from cratous.core.files.private_cache import private_cache
    from cratous.proofs.elsewhere import Beside, said_proved

    folder = private_cache() / "proofs-elsewhere"
    with Bar("asking workers", len(names), not quiet and sys.stderr.isatty()) as bar:
        proved = _asked(names, home, scheduler, folder, bar)
    others = [name for name in names if name not in proved]
    told = f"; not: {', '.join(others)}" if others else ""
    click.echo(f"workers say that {len(proved)} of {len(names)} are proved{told}", err=True)
    if whole:
        return []
    cache = Beside(private_cache() / "proofs", folder)
    with Bar("reading answers", len(proved), not quiet and sys.stderr.isatty()) as bar:
        return said_proved(
            proved, home, cache, jobs=jobs, tell=lambda name: bar.step(name, 1, 1)
        )  # fmt: skip


def _asked(names: list[str], home: Any, scheduler: str, folder: Path, bar: Any) -> list[str]:
    """The names of theorems that workers report as proved; their answers are in the folder."""
    from cratous.proofs.elsewhere import kept
    from cratous.services.campaign.engine import engine, refuse_other_version
    from cratous.services.campaign.identity import version_digest

    ours, who = version(home), f"a worker of {scheduler}"
    waiting, tries = deque(names), dict.fromkeys(names, 0)
    proved: set[str] = set()

    def feed() -> dict[str, Any] | None:
        if not waiting:
            return None
        name = waiting.popleft()
        return {
            "id": name, "function": FUNCTION, "version": version_digest(), "memory_mb": MEMORY_MB,
            "time_s": TIME_S, "run": {"theorem": name, "package": home.name, "version": ours},
        }  # fmt: skip

    with engine(1, scheduler) as made:
        for answer in made(feed):
            heed()
            if answer is None:
                continue
            name = answer.task["id"]
            if "lost" in answer.answer:
                tries[name] += 1
                if tries[name] < ATTEMPTS:
                    waiting.append(name)
                    continue
                click.echo(f"no worker answers on {name}: {answer.answer['lost']}", err=True)
            else:
                result = answer.answer["result"]
                refuse_other_version(result, who)
                if "not stated" not in result and kept(result, folder, who):
                    proved.add(name)
            bar.step(name, 1, 1)
    return [name for name in names if name in proved]
