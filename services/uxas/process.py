"""A running UxAS: bus, manager, ports and the main loop. One thread, no timers.

By default time is the machine's (`Clock`); due events happen at their own virtual time, in order,
however late the loop processes them. `virtual=True` waits for nothing: time jumps from one wake-up
to the next, so that the same configuration gives the same messages; it allows no bridges.
"""

from __future__ import annotations

import contextlib
import os
import resource
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import zmq

from cratous.bridge import lmcp
from cratous.bridge.port import is_due, often
from cratous.services.bus import Bus, Envelope
from cratous.services.loading.uxas_settings import Configuration
from cratous.services.pipeline.status import status
from cratous.services.uxas.bridge_kinds import curve_of
from cratous.services.uxas.frame import Clock, Host
from cratous.services.uxas.hub import Hub, RemoteBus, Satellite
from cratous.services.uxas.logs import Logs, writing_in
from cratous.services.uxas.manager import ServiceManager, startup
from cratous.spec.errors import BadInput, CratousError, NoPlan

_LONGEST_POLL_MS = 200  # so that a signal or a discrete clock is noticed
_QUIET_MS = 20
"""Idle time before a piece of background work is done [ms]."""
_FILES = 65536
_NEVER_MS = 2**62


class Process:
    """One UxAS process; `run` until its end, then `close`. Use as a context manager."""

    def __init__(
        self,
        config: Configuration,
        log: Logs,
        *,
        without: frozenset[str] = frozenset(),
        virtual: bool = False,
        say: Callable[[str], None] = print,
        data: Path | None = None,
        clock: Clock | None = None,
    ) -> None:
        """BadInput states the errors of the configuration; nothing stays open then.

        data: folder in which services write; without one, none may.
        """
        root = config.root
        self.log, self.config, self._virtual = log, config, virtual
        self.clock = clock or Clock()
        self.context: zmq.Context[Any] = zmq.Context()
        self.context.max_sockets = 4096
        self._hub: Hub | None = None
        self._satellite: Satellite | None = None
        self._doorkeeper: Any = None
        self._poller: zmq.Poller | None = None
        self._handles: list[tuple[Any, int]] = []
        self._faults: Counter[tuple[str, str, str]] = Counter()
        self._spare: Iterator[bool] | None = None
        self._idle = False
        self.stopping = False
        joined = _addresses(config, ("HubSUB", "HubPUSH"))
        hosts = _addresses(config, ("HubPUB", "HubPULL"))
        if joined and hosts:
            raise BadInput(
                "a hub and a satellite at once",
                where=config.where,
                item="UxAS.HubSUB",
                expected="HubPUB and HubPULL, or HubSUB and HubPUSH",
            )
        make = RemoteBus if joined else Bus
        self.bus = make(lmcp.full_names, on_fault=self._fault, echo=False)
        self.host = Host(
            self.bus,
            log,
            self.clock,
            root["EntityID"],
            root["EntityType"],
            config.path,
            {**root, "where": config.where, "strict": config.strict},
            {"admit": self._admit, "data": data},
            say,
        )
        if joined and root["FirstServiceID"] is None:
            raise BadInput(
                "a range of service ids of its own is needed",
                where=config.where,
                item="UxAS.FirstServiceID",
                expected="a number whose followers no other process on the hub has",
            )
        _raise_file_limit()
        self.manager = ServiceManager(self.host, config, self.context)
        try:
            curve = curve_of(root, config.where, config.path, "hub")
            if curve is not None:
                self._admit(curve)
            if hosts:
                self._hub = Hub(self.host, self.context, *hosts, curve)
            if joined:
                self._satellite = Satellite(self.host, self.context, *joined, curve)
            self.manager.build(without)
            if virtual and (self.manager.bridges or hosts or joined):
                raise BadInput(
                    "virtual time has no outside",
                    where=config.where,
                    expected="a configuration without bridges and hub",
                )
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def ports(self) -> list[Any]:
        """All objects with sockets: hub or satellite, then bridges."""
        found: list[Any] = [p for p in (self._hub, self._satellite) if p is not None]
        return found + list(self.manager.bridges.values())

    def run(self, until_s: float | None = None, spare: Iterator[bool] | None = None) -> None:
        """Run until `until_s` seconds have passed, KillService -1 arrives, or `stopping` is set.

        Start-up is complete when all entities that services wait for have connected; time counts
        from then on. spare: background work done piece by piece when idle, before the first
        request; each item says whether there was any. Not used in virtual time, which has no idle
        time.
        """
        if spare is not None and not self._virtual:
            self._spare = spare
            self.bus.tap(self._asked)
        while self._awaits() and not (self.stopping or self.manager.ended):
            self.turn()
        startup(self.bus)
        if self._virtual:
            self._run_virtual(until_s)
            return
        end_s = None if until_s is None else self.clock.real_s() + until_s
        while not (self.stopping or self.manager.ended):
            now_s = self.clock.real_s()
            if is_due(end_s, now_s):
                break
            self.turn(None if end_s is None else end_s - now_s)

    def turn(self, most_s: float | None = None) -> None:
        """Wait for the next event, at most `most_s`, and process everything due."""
        self._wait(most_s)
        if self._doorkeeper is not None:
            self._doorkeeper.step()
        now_s = time.monotonic()
        for port in self.ports:
            port.pump(now_s)
        self.bus.run_until(self.clock.now_ms())
        if self.clock.discrete:  # a state has given the time: what follows happens at that time
            self.bus.run_until(self.clock.now_ms())

    def _awaits(self) -> bool:
        now_s = time.monotonic()
        waiting = [port.awaits(now_s) for port in self.ports if hasattr(port, "awaits")]
        return any(waiting)  # each has logged for whom it waits

    def close(self) -> None:
        """End all services, close all sockets. Safe to call twice."""
        if self.context.closed:
            return
        self.manager.close()
        for part in (self._hub, self._satellite, self._doorkeeper):
            if part is not None:
                part.close()
        self.context.destroy(linger=200)

    def _run_virtual(self, until_s: float | None) -> None:
        self.bus.run()
        end_ms = None if until_s is None else int(1000 * until_s)
        span = range(_NEVER_MS if end_ms is None else end_ms + 1)
        while not (self.stopping or self.manager.ended):
            due_ms = self.bus.next_wake_ms()
            if due_ms is None or due_ms not in span:
                break
            self.bus.run_until(due_ms)
        if end_ms is not None and not self.manager.ended:
            self.bus.run_until(end_ms)

    def _wait(self, most_s: float | None) -> None:
        handles = [h for port in self.ports for h in port.port.handles()]
        if self._doorkeeper is not None:
            handles += self._doorkeeper.handles()
        if self._poller is None or handles != self._handles:
            self._poller, self._handles = zmq.Poller(), handles
            for handle, flags in handles:
                self._poller.register(handle, flags)
        wait_ms = float(_LONGEST_POLL_MS)
        if most_s is not None:
            wait_ms = min(wait_ms, 1000 * most_s)
        due_ms = self.bus.next_wake_ms()
        if due_ms is not None and not self.clock.discrete:
            wait_ms = min(wait_ms, due_ms - 1000 * self.clock.real_s())
        now_s = time.monotonic()
        for port in self.ports:
            if port.port.due_s is not None:
                wait_ms = min(wait_ms, 1000 * (port.port.due_s - now_s))
        wait = max(0, int(wait_ms + 0.999))
        spare = self._spare is not None and wait > _QUIET_MS
        if not self._heard(_QUIET_MS if spare and not self._idle else wait) and spare:
            self._use_spare_time()

    def _heard(self, wait_ms: int) -> bool:
        """Wait up to wait_ms for input; whether there is any."""
        if not self._handles:
            time.sleep(wait_ms / 1000)
            return False
        assert self._poller is not None
        with contextlib.suppress(InterruptedError):
            return bool(self._poller.poll(wait_ms))
        return True  # interrupted by a signal

    def _asked(self, envelope: Envelope) -> None:
        """Stop background work after the first automation request, where it would only cause delay."""
        if envelope.topic.endswith("AutomationRequest"):
            self._spare = None

    def _use_spare_time(self) -> None:
        """Do one piece of background work."""
        assert self._spare is not None
        try:
            self._idle = not next(self._spare)
        except StopIteration:
            self._spare = None
        except Exception as error:
            self._spare = None
            self.log("WARN", f"the first request will take longer: {type(error).__name__}: {error}")

    def _admit(self, curve: Any) -> None:
        from cratous.bridge.zmq_curve import Doorkeeper

        if self._doorkeeper is None:
            self._doorkeeper = Doorkeeper(self.context)
        self._doorkeeper.admit(curve)
        if curve.server is None and curve.clients is None:  # it binds, and has no list
            where = f"{curve.where}: " if curve.where else ""
            self.log("WARN", f"{where}no CurveClientKeys: whoever has any key is let in")

    def _fault(self, name: str, envelope: Envelope | None, error: Exception) -> None:
        what = f"message {envelope.seq} ({envelope.topic})" if envelope else "its own doing"
        kind = "" if isinstance(error, CratousError) else f"{type(error).__name__}: "
        same = (name, envelope.topic if envelope else "", type(error).__name__)
        self._faults[same] += 1
        if often(self._faults[same]):
            more = f" ({self._faults[same]} of this kind so far)" if self._faults[same] > 1 else ""
            self.log("ERROR", f"{name} fails at {what}: {kind}{error}{more}")
        if os.environ.get("CRATOUS_DEBUG"):
            import traceback

            self.log("DEBUG", "".join(traceback.format_exception(error)))
        number = _request_of(envelope.body) if envelope else 0
        if not number or not _plans(name):
            return  # the validator answers unanswered requests when their time is over
        reasons = error.reasons if isinstance(error, NoPlan) else (f"{name}: {kind}{error}",)
        self.bus.publish(status(number, "Error", [("reason", text) for text in reasons]), name)


def _request_of(body: Any) -> int:
    """The automation request to which a message of the pipeline belongs, 0 if it has none."""
    if type(body).__name__ == "UniqueAutomationRequest":
        return int(body.RequestID)
    return int(getattr(body, "CorrespondingAutomationRequestID", 0))


def _plans(name: str) -> bool:
    from cratous.services.uxas.registry import KINDS

    kind = KINDS.get(name)
    return (kind is not None and kind.plans) or "[" in name


def _addresses(config: Configuration, names: tuple[str, str]) -> tuple[str, str] | None:
    values = config.root[names[0]], config.root[names[1]]
    if not any(values):
        return None
    for name, value in zip(names, values, strict=True):
        if not value:
            raise BadInput(
                "half of a pair",
                where=config.where,
                item=f"UxAS.{name}",
                expected=f"{names[0]} and {names[1]}",
            )
    return values


def _raise_file_limit() -> None:
    """Raise the file limit to the system's maximum, at most 65,536, for many connections."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    most = _FILES if hard == resource.RLIM_INFINITY else min(hard, _FILES)
    if soft != resource.RLIM_INFINITY and soft < most:
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))


def data_folder(config: Configuration, here: Path) -> Path:
    """The folder `datawork`, created as in UxAS; with isDataTimestamp a subfolder named by the time."""
    folder = here / "datawork"
    if config.root["isDataTimestamp"]:
        folder = folder / str(time.time_ns() // 1_000_000)
    with writing_in(folder, "the data folder cannot be made"):
        folder.mkdir(parents=True, exist_ok=True)
    return folder
