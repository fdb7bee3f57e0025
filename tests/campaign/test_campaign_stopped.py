"""A signal to stop comes up as itself, whatever dask does when it is closed."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from campaign_child import written

from cratous.services import cli
from cratous.services.campaign import engine
from cratous.services.cli.stopping import Stopped
from cratous.spec.errors import BadInput

pytest.importorskip("distributed")


class Slow:
    """A client and a cluster of dask that close and cancel as a machine that is too busy does."""

    status = "running"

    def __init__(self, *_: Any, **__: Any) -> None:
        self.asked = list[str]()

    def close(self, timeout: int) -> None:
        self.asked.append("close")
        raise TimeoutError(f"timed out after {timeout} s.")

    def cancel(self, _futures: Any, force: bool) -> None:
        self.asked.append("cancel")
        raise OSError("the connection is gone")

    def nthreads(self) -> dict[str, int]:
        return {"worker": 1}

    def subscribe_topic(self, _topic: str, _note: Any) -> None:
        """Nobody says anything."""

    def submit(self, *_: Any, **__: Any) -> Any:
        return object()


@pytest.mark.parametrize("error", [RuntimeError, TimeoutError, BadInput])
def test_an_error_on_the_way_out_of_a_stop_is_told_and_the_exit_code_is_the_signals(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], error: type[Exception]
) -> None:
    def stopped(**_: Any) -> None:
        try:
            raise Stopped(signal.SIGTERM)
        finally:
            try:
                raise OSError("gone")
            except OSError:
                raise error("cannot be closed") from None

    monkeypatch.setattr(cli.cli, "main", stopped)
    assert cli.main(["campaign"]) == 143
    assert capsys.readouterr().err == (
        f"cratous: stopped (SIGTERM); on the way out: {error.__name__}: cannot be closed\n"
    )


@pytest.mark.parametrize("stopped", [True, False])
def test_an_error_of_closing_hides_neither_a_stop_nor_a_result(
    monkeypatch: pytest.MonkeyPatch, stopped: bool
) -> None:
    client, cluster = Slow(), Slow()

    def wait(*_: Any, **__: Any) -> None:
        raise Stopped(signal.SIGTERM)

    made = SimpleNamespace(
        Client=lambda *_, **__: client, LocalCluster=lambda **_: cluster, wait=wait,
        client=SimpleNamespace(ClosedClientError=ConnectionError),
    )  # fmt: skip
    monkeypatch.setattr(engine, "_distributed", lambda: made)
    tasks = iter([{"id": "1"}] if stopped else [])

    def flown() -> None:
        with engine.engine(2, None) as fly:
            list(fly(lambda: next(tasks, None)))

    if stopped:
        with pytest.raises(Stopped) as stop:
            flown()
        assert stop.value.exit_code == 143
    else:
        flown()
    assert (client.asked, cluster.asked) == (["cancel", "close"], ["close"])


def test_a_stop_that_a_library_has_swallowed_ends_the_campaign_all_the_same(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    looks = 0

    @contextmanager
    def swallowing(*_: Any) -> Iterator[engine.Engine]:
        def made(_feed: engine.Feed) -> Iterator[engine.Answer | None]:
            nonlocal looks
            try:
                os.kill(os.getpid(), signal.SIGTERM)
                signal.pause()
            except BaseException:
                looks = 0
            while looks < 5:
                looks += 1
                yield None

        yield made

    monkeypatch.setattr(engine, "engine", swallowing)
    file = written(tmp_path, {"plain": ""}, "")
    assert cli.main(["campaign", str(file), "--allow-unproved", "-o", str(tmp_path / "out")]) == 143
    assert looks == 1, "at the next look"
    assert "cratous: stopped (SIGTERM)\n" in capsys.readouterr().err
    assert not (tmp_path / "out" / "campaign.json").exists()
