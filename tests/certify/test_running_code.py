"""Which code of services and bridge ran: in log and report, held against its files and the release."""

from __future__ import annotations

import base64
import hashlib
from types import CodeType

import pytest

from cratous.services.certify import running_code as module
from cratous.services.certify.flight_record import _is_code
from cratous.services.certify.report import environment
from cratous.services.certify.running_code import NO_RELEASE, against, running_code
from cratous.services.logs import records


@pytest.fixture(autouse=True)
def _anew():
    running_code.cache_clear()
    module.code_digest.cache_clear()
    yield
    running_code.cache_clear()
    module.code_digest.cache_clear()


def _recorded(files: dict[str, bytes]) -> dict[str, str]:
    return {
        place: base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        for place, data in files.items()
    }


def test_files_are_held_against_a_release():
    files = {"services/a.py": b"x = 1\n", "bridge/b.py": b""}
    assert against(files, {}, "1.0") == NO_RELEASE
    assert against(files, _recorded(files), "1.0") == "release 1.0"
    changed = {**files, "services/a.py": b"x = 2\n"}
    assert against(changed, _recorded(files), "1.0") == "differs from release 1.0: services/a.py"
    more = {**files, "services/c.py": b""}
    assert against(more, _recorded(files), "1.0") == "differs from release 1.0: services/c.py"
    assert against(files, _recorded(more), "1.0") == "differs from release 1.0: services/c.py"


def test_another_text_is_another_code(monkeypatch):
    first = running_code()
    assert _is_code(first)
    assert first == environment()["code"]
    files = module._files()
    assert "services/certify/report.py" in files
    running_code.cache_clear()
    module.code_digest.cache_clear()
    monkeypatch.setattr(
        module, "_files", lambda: {**files, "services/certify/report.py": b"pass\n"}
    )
    assert running_code()["digest"] != first["digest"]


def _other(*parts: object) -> str:
    return "another"


def test_a_function_that_was_changed_while_it_runs_is_named(monkeypatch):
    assert running_code()["running"] == "as its files say"
    running_code.cache_clear()
    module.code_digest.cache_clear()
    code: CodeType = _other.__code__
    monkeypatch.setattr(records.fingerprint, "__code__", code)
    assert running_code()["running"] == "not what its files say: services.logs.records.fingerprint"


@pytest.mark.parametrize(
    "data", [{}, {"digest": "1"}, {"digest": 1, "running": "", "release": ""}, []]
)
def test_other_data_are_no_code(data):
    assert not _is_code(data)
    assert _is_code(None)
