"""Executes attempts: in one flier of this process, or on workers of dask.distributed."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import AbstractContextManager, contextmanager, suppress
from typing import Any, NamedTuple

from cratous.services.campaign import worker
from cratous.spec.errors import BadInput, Refused

Attempt = dict[str, Any]
Feed = Callable[[], Attempt | None]
"""Returns the next attempt, None while there is none."""
WINDOW = 2
"""Attempts in progress per worker, so that no worker idles."""
LOOK = 0.5
"""Polling interval while waiting [s]."""


CHANGED = (
    "this machine, where CRATOUS, Python or its packages have changed since the campaign was begun,"
)
"""Description of this machine in errors on another version."""


class Answer(NamedTuple):
    """The result of an attempt; died: attempts that the engine lost and repeated on its own."""

    task: Attempt
    answer: dict[str, Any]
    died: int = 0


Engine = Callable[[Feed], Iterator[Answer | None]]
"""Executes attempts from a feed, and yields answers in any order, None from time to time while waiting."""


def refuse_other_version(answer: dict[str, Any], who: str) -> None:
    """Raise if the answer came from another version."""
    if "other version" in answer:
        raise Refused(
            f"{who} has another version ({answer['other version'][:12]}): results of two versions are "
            "not mixed; what is stored stays, and the same command does what this version has not done"
        )


@contextmanager
def here() -> Iterator[Engine]:
    """One flier of this process."""

    def made(feed: Feed) -> Iterator[Answer | None]:
        while (task := feed()) is not None:
            answer = worker.attempt(task)
            refuse_other_version(answer, CHANGED)
            yield Answer(task, answer)

    try:
        yield made
    finally:
        worker.end()


def engine(workers: int, scheduler: str | None) -> AbstractContextManager[Engine]:
    """The engine for a number of local workers, or for the scheduler at an address."""
    return here() if workers == 1 and scheduler is None else _cluster(workers, scheduler)


def _distributed() -> Any:
    try:
        import distributed
    except ImportError:
        raise BadInput(
            "dask.distributed is not installed, without which there is one worker",
            expected="--workers 1, or `pip install cratous[campaign]`",
        ) from None
    return distributed


@contextmanager
def _cluster(workers: int, scheduler: str | None) -> Iterator[Engine]:
    distributed = _distributed()
    import dask

    settings = {
        "distributed.scheduler.allowed-failures": 0,
        "distributed.scheduler.worker-ttl": "60s",
        "distributed.comm.timeouts.connect": "20s",
    }
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # we report what matters
    with dask.config.set(settings):
        cluster = None
        try:
            if scheduler is None:
                cluster = distributed.LocalCluster(
                    n_workers=workers, threads_per_worker=1, processes=True, host="127.0.0.1",
                    dashboard_address=None, memory_limit=0, silence_logs="CRITICAL",
                )  # fmt: skip
            client = _client(distributed, cluster or scheduler)
            try:
                yield lambda feed: _made(distributed, client, scheduler or "local workers", feed)
            finally:
                _ended(client, 5)
        finally:
            if cluster is not None:
                _ended(cluster, 10)


def _ended(closable: Any, timeout: int) -> None:
    """Close a client or cluster; what does not end in time ends with this process.

    The results have been received by then, and an error here would hide the reason for closing, for
    example a stop signal.
    """
    with suppress(Exception):
        closable.close(timeout=timeout)


def _client(distributed: Any, address: Any) -> Any:
    try:
        return distributed.Client(address, timeout=20)
    except (OSError, ValueError, TimeoutError) as error:
        raise BadInput(
            "there is no scheduler", where=str(address), expected="its address, like tcp://host:8786",
            got=str(error)[:200],
        ) from None  # fmt: skip


class _Starts:
    """How often an attempt at each key was started: workers report starts, and a dead worker's attempt is restarted."""

    def __init__(self, client: Any, topic: str) -> None:
        self.topic, self._begun = topic, dict[str, int]()
        client.subscribe_topic(topic, self._note)

    def _note(self, event: Any) -> None:
        key = str(event[1])
        self._begun[key] = self._begun.get(key, 0) + 1

    def taken(self, key: str) -> int:
        """Attempts at a key so far, at least one; forgotten then."""
        return self._begun.pop(key, 1)


def announced(topic: str, key: str, task: Attempt) -> dict[str, Any]:
    """An attempt in a worker of dask, which says first that it begins."""
    from distributed import get_worker

    get_worker().log_event(topic, key)
    return worker.attempt(task)


def _made(distributed: Any, client: Any, where: str, feed: Feed) -> Iterator[Answer | None]:
    import uuid

    starts = _Starts(client, f"cratous-{uuid.uuid4().hex}")  # distinct from other clients' events
    running: dict[Any, Attempt] = {}
    count = 0
    try:
        while True:
            width = WINDOW * max(1, sum(client.nthreads().values()))
            while len(running) < width and (task := feed()) is not None:
                count += 1
                key = f"{starts.topic}-{count}"
                future = client.submit(announced, starts.topic, key, task, key=key, pure=False)
                running[future] = task
            if not running:
                return
            for future in _done(distributed, running):
                task = running.pop(future)
                yield _answer(future, task, starts, where)
            yield None
            if client.status != "running":
                raise _gone(where)
    except (CancelledError, OSError, distributed.client.ClosedClientError):
        raise _gone(where) from None  # a scheduler that ends cancels all work in progress
    finally:
        if client.status == "running":
            with suppress(Exception):  # the same as in `_ended`
                client.cancel(list(running), force=True)


def _done(distributed: Any, running: Iterable[Any]) -> list[Any]:
    """The finished attempts, after a bounded wait."""
    futures = list(running)
    try:
        distributed.wait(futures, timeout=LOOK, return_when="FIRST_COMPLETED")
    except TimeoutError:
        return []
    return [future for future in futures if future.done()]


def _answer(future: Any, task: Attempt, starts: _Starts, where: str) -> Answer:
    """The result of an attempt from dask, or how it failed."""
    if future.status in ("cancelled", "lost"):
        raise _gone(where)
    begun = starts.taken(future.key)
    if future.status == "error":
        error = future.exception()
        if type(error).__name__ != "KilledWorker":
            raise Refused(f"a worker of {where} cannot fly: {type(error).__name__}: {error}"[:500])
        return Answer(task, {"lost": "its worker died"}, begun - 1)
    answer = future.result()
    refuse_other_version(answer, f"a worker of {where}")
    return Answer(task, answer, begun - 1)


def _gone(where: str) -> BadInput:
    return BadInput(
        "the scheduler is gone; what is stored stays, and the same command goes on from there",
        where=where, expected="a scheduler that runs",
    )  # fmt: skip
