"""The message logger: a service that writes every message it is configured for to a log.

UxAS mounts it as MessageLoggerDataService: `LogMessage MessageType` is a prefix of addresses
("afrl" selects all of CMASI), `LogFileName` the prefix of file names, `LogFileMessageCountLimit`
enables text files beside the database, with that many messages each, `FilesPerSubDirectory` sets
the number of files per folder. `NumberMessagesToSkip` is the number of messages of a type to skip
after each one that is logged.

    logger = MessageLogger.from_element(element, folder, "cfg.xml")
    bus.add(logger)            # where the bus knows `prefixes`; else: bus.tap(logger.tap)
    logger.close()

Its decision is a pure step (`choose`); the log that receives the messages is the shell. The body is
logged as its LMCP bytes, as received from outside if available, so that types without a model are
logged too. On a bus, the text files are written once the messages queued with theirs are delivered,
at most WAITING_MOST messages late, so that a response does not wait for them. If the log cannot be written it continues, reports it on the bus (ServiceStatus, once at
the start and once at the end of the failure), and counts what is lost.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.bus import Envelope, Wake
from cratous.services.logs.entry import Entry, to_object
from cratous.services.logs.records import canonical
from cratous.services.logs.store import LogStore, cannot_write
from cratous.services.logs.text_files import TextFiles
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import integer_of

STEM = "messageLog"
_NAME = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9._-]{0,99}")
SERVICE_TYPE = "MessageLoggerDataService"
WAITING_MOST = 1000
"""Number of messages of which the text may still be written."""


class LogRule(NamedTuple):
    """Messages to log: a prefix of their address, and how many to skip after each."""

    prefix: str
    skip: int = 0


class LoggerState(NamedTuple):
    """What the logger remembers: messages still to skip by type; whether it has complained."""

    to_skip: dict[str, int] = {}  # noqa: RUF012 (never changed, replaced by a new one)
    complained: bool = False


class MessageLogger:
    """A service that writes one log; see the module."""

    subscribes: tuple[str, ...] = ()

    def __init__(
        self,
        folder: Path,
        rules: Iterable[LogRule] = (LogRule(""),),
        *,
        name: str = SERVICE_TYPE,
        stem: str = STEM,
        text_limit: int = 0,
        files_per_folder: int = 0,
        path: Path | None = None,
        **store: Any,
    ) -> None:
        """A new log `<stem>_<n>.sqlite` in the folder (or at `path`); BadInput if it cannot be
        created.

        text_limit: messages per text file, 0 for no text files; store: arguments of `LogStore`, and
        meta data of the log.
        """
        self.name = name
        self.rules = tuple(rules)
        self.prefixes = tuple(dict.fromkeys(rule.prefix for rule in self.rules))
        self._skips = any(rule.skip for rule in self.rules)
        path, number = (path, 0) if path is not None else _free(folder, stem)
        store = {"writer": SERVICE_TYPE, **store}
        self.log = LogStore(path, **store)
        self._texts: TextFiles | None = None
        if text_limit > 0:
            self._texts = TextFiles(folder, f"{stem}_{number}", text_limit, files_per_folder)
        self._waiting: deque[Entry] = deque()
        self._tap_state = self.start()

    @classmethod
    def from_element(cls, element: Any, folder: Path, where: str, **store: Any) -> MessageLogger:
        """The logger configured by an element `Service` of a configuration; BadInput with file and line."""
        place = f"{where}:{element.sourceline}"
        return cls.from_parts(element.attrib, tuple(element), folder, place, **store)

    @classmethod
    def from_parts(
        cls,
        attributes: Mapping[str, str],
        children: Iterable[Any],
        folder: Path,
        where: str,
        **store: Any,
    ) -> MessageLogger:
        """The same from an element's attributes and children; where: its `file:line`."""
        file, rules = where.rpartition(":")[0], []
        for child in children:
            place = f"{file}:{child.sourceline}"
            if child.tag != "LogMessage":
                raise BadInput(
                    "unknown element", where=place, expected="LogMessage", got=str(child.tag)
                )
            prefix = child.get("MessageType", "")
            if not prefix:
                raise BadInput("no message type", where=place, item="LogMessage.MessageType")
            rules.append(LogRule(prefix, _whole(child, "NumberMessagesToSkip", place)))
        return cls(
            folder,
            rules,
            stem=_stem(attributes, where),
            text_limit=_whole(attributes, "LogFileMessageCountLimit", where),
            files_per_folder=_whole(attributes, "FilesPerSubDirectory", where),
            **store,
        )

    def start(self) -> LoggerState:
        """The initial state: nothing is skipped yet."""
        return LoggerState()

    def choose(self, state: LoggerState, envelope: Envelope) -> tuple[LoggerState, bool]:
        """The pure step: the next state, and whether this message is logged."""
        address = getattr(envelope, "address", "") or envelope.topic
        if not address.startswith(self.prefixes):
            return state, False
        if not self._skips:
            return state, True
        left = state.to_skip.get(envelope.topic, 0)
        skip = min(rule.skip for rule in self.rules if address.startswith(rule.prefix))
        to_skip = {**state.to_skip, envelope.topic: left - 1 if left else skip}
        return state._replace(to_skip=to_skip), not left

    def handle(
        self, state: LoggerState, envelope: Envelope, now_ms: int
    ) -> tuple[LoggerState, Iterable[Any]]:
        """Log one message if it is chosen; publishes a status when the log fails and when it recovers."""
        state, chosen = self.choose(state, envelope)
        if not chosen:
            return state, ()
        entry, problem = entry_of(envelope)
        self.log.write(entry)
        said: list[Any] = [] if problem is None else [_status("Warning", str(problem))]
        if self._texts is not None:
            self._waiting.append(entry)
            if len(self._waiting) >= WAITING_MOST:
                self._write_texts()
            elif len(self._waiting) == 1:
                said.append(Wake(0))
        return self._judged(state, said)

    def wake(self, state: LoggerState, key: None, now_ms: int) -> tuple[LoggerState, Iterable[Any]]:
        """Write the text files."""
        self._write_texts()
        return self._judged(state, [])

    def _write_texts(self) -> None:
        while self._texts is not None and self._waiting:
            entry = self._waiting.popleft()  # one by one: what is interrupted keeps the others
            self._texts.write(entry, _xml(entry))

    def _judged(self, state: LoggerState, said: list[Any]) -> tuple[LoggerState, Iterable[Any]]:
        trouble = self.log.trouble or (self._texts.trouble if self._texts is not None else "")
        if bool(trouble) != state.complained:
            state = state._replace(complained=bool(trouble))
            said.append(self._report(trouble))
        return state, said

    def _report(self, trouble: str) -> Any:
        if trouble:
            return _status("Error", f"{self.log.path}: cannot be written ({trouble})")
        return _status("Warning", f"{self.log.path}: written again; {self.log.lost} messages lost")

    def tap(self, envelope: Envelope) -> None:
        """The same for `Bus.tap`: every message, in order; errors are shown in `log.trouble`."""
        self._tap_state, _ = self.handle(self._tap_state, envelope, envelope.time_ms)
        self._write_texts()

    def stop(self, state: LoggerState) -> None:
        """The service leaves the bus."""
        self.close()

    def close(self) -> None:
        """Write the remaining messages and close the log; BadInput if something is not on disk."""
        self._write_texts()
        if self._texts is not None:
            self._texts.close()
        self.log.close()
        if self._texts is not None and self._texts.lost:
            raise BadInput(
                f"the text files are not whole: {self._texts.lost} messages are lost",
                where=str(self.log.path.parent),
            )


def entry_of(envelope: Envelope) -> tuple[Entry, BadInput | None]:
    """The log entry of a message, and the error if its body has no LMCP form (then logged as text)."""
    problem: BadInput | None = None
    try:
        body: str | bytes = envelope.packed
    except BadInput as error:
        problem = error
        try:
            body = lmcp.to_json(envelope.body)
        except BadInput:
            body = canonical({"$text": repr(envelope.body)[:10_000]})
        # half of a surrogate pair has no form in a file; as an escape it is the same JSON
        body = body.encode("utf-8", "backslashreplace").decode()
    entity, service = (getattr(envelope, name, 0) for name in ("entity_id", "service_id"))
    outside = (
        getattr(envelope, "address", "") or None,
        getattr(envelope, "group", "") or None,
        str(entity) if entity or service else None,
        str(service) if entity or service else None,
    )
    head = (envelope.seq, envelope.time_ms, envelope.source, envelope.topic)
    return Entry(*head, body, *outside), problem


def _xml(entry: Entry) -> str:
    try:
        return lmcp.xml.dumps(to_object(entry))
    except BadInput as error:
        body = entry.body.hex() if isinstance(entry.body, bytes) else entry.body
        return f"[no XML: {error}] {body}\n"


def _status(kind: str, text: str) -> Any:
    # RequestID 0: an error without one ends the request that is being planned
    pairs = ((SERVICE_TYPE, text[:1000]), ("RequestID", "0"))
    info = [lmcp.new("KeyValuePair", Key=key, Value=value) for key, value in pairs]
    return lmcp.new("ServiceStatus", StatusType=kind, Info=info)


def _stem(attributes: Mapping[str, str], where: str) -> str:
    name = attributes.get("LogFileName", "") or STEM
    if not _NAME.fullmatch(name):
        raise BadInput(
            "no name of a file",
            where=where,
            item="LogFileName",
            expected="up to 100 letters, digits, '.', '_' and '-', not '.' at the begin",
            got=name,
        )
    return name


def _free(folder: Path, stem: str) -> tuple[Path, int]:
    """The first unused log name in the folder, and its number."""
    number = 0
    try:
        while (path := folder / f"{stem}_{number}.sqlite").exists():
            number += 1
    except OSError as error:
        raise cannot_write(folder, error) from None
    return path, number


def _whole(element: Any, name: str, where: str) -> int:
    text = element.get(name, "0").strip()
    number = integer_of(text, 0, 2**32 - 1)
    if number is None:
        raise BadInput(
            "wrong attribute", where=where, item=name, expected="a whole number from 0", got=text
        )
    return number
