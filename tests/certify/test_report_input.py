"""What is read as a report: a file from anywhere, refused with its name where it is none."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cratous.services.certify.report_input import read_report
from cratous.spec.errors import BadInput

BAD = {
    "cut": "{",
    "empty": "",
    "list": "[]",
    "other": '{"format": "other"}',
    "format": '{"format": ["cratous-report/1"]}',
    "nan": '{"format": "cratous-report/1", "exit_code": NaN}',
    "infinite": '{"format": "cratous-report/1", "exit_code": 1e999}',
    "digits": '{"format": "cratous-report/1", "exit_code": ' + "9" * 5000 + "}",
    "deep": '{"format": "cratous-report/1", "x": ' + "[" * 200_000 + "]" * 200_000 + "}",
    "nested": '{"format": "cratous-report/1", "x": ' + "[" * 300 + "]" * 300 + "}",
    "twice": '{"format": "cratous-report/1", "a": 1, "a": 2}',
}


@pytest.mark.parametrize("case", BAD)
def test_what_is_no_report(tmp_path: Path, case: str) -> None:
    (tmp_path / "report.json").write_text(BAD[case])
    with pytest.raises(BadInput) as caught:
        read_report(tmp_path)
    assert str(tmp_path / "report.json") in str(caught.value)
    assert len(str(caught.value)) < 500


def test_reports_that_cannot_be_read(tmp_path: Path) -> None:
    file = tmp_path / "report.json"
    with pytest.raises(BadInput, match="no such file"):
        read_report(tmp_path)
    file.write_bytes(b"\xff\xfe{")
    with pytest.raises(BadInput, match="not JSON"):
        read_report(tmp_path)
    file.unlink()
    file.mkdir()
    with pytest.raises(BadInput, match="not a file"):
        read_report(tmp_path)
    file.rmdir()
    os.mkfifo(file)
    with pytest.raises(BadInput, match="not a file"):
        read_report(tmp_path)
    file.unlink()
    with file.open("wb") as stream:
        stream.truncate(1 << 29)
    with pytest.raises(BadInput, match="too large"):
        read_report(tmp_path)
