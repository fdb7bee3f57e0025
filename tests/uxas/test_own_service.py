"""A service of the user's own: the guide is followed to the letter, and mistakes are named."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from uxas_tools import process, write_cfg

from cratous.bridge import lmcp
from cratous.services.cli import main
from cratous.services.loading.problems import BadMission
from cratous.spec.errors import BadInput


def blocks(page: Path) -> dict[str, str]:
    """The page's files: a name in backticks, then a block."""
    found = re.findall(r"^`([\w.]+)`[^\n]*:\n```\w+\n(.*?)^```", page.read_text(), re.M | re.S)
    return dict(found)


@pytest.fixture
def written(root: Path, tmp_path: Path) -> Path:
    for name, text in blocks(root / "docs/guides/own-service.md").items():
        (tmp_path / name).write_text(text)
    return tmp_path


def state(number: int, energy: float) -> Any:
    return lmcp.new("AirVehicleState", ID=number, EnergyAvailable=energy)


def test_the_guide_makes_a_service_that_runs(written: Path) -> None:
    lines = (written / "low_energy.py").read_text().split("class ")[1].splitlines()
    assert len([line for line in lines if line.strip()]) <= 20
    one, said = process(written / "cfg.xml", virtual=True)
    seen: list[Any] = []
    one.bus.tap(lambda e: "KeyValue" in e.topic and seen.append((e.source, e.body.Value)))
    for number, energy in ((1, 80.0), (1, 29.0), (2, 30.0), (1, 28.0), (2, 1.0)):
        one.bus.publish(state(number, energy), "test")
    one.run(0.0)
    assert [value for _, value in seen] == ["1", "2"]
    assert said.has("LowEnergy")
    one.close()


def test_its_attributes_are_checked_like_all_others(
    written: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    cfg = written / "cfg.xml"
    monkeypatch.chdir(written)
    assert main(["uxas", "--check"]) == 0
    text = cfg.read_text()
    for wrong, words in (
        ('Least_percent="300"', "a number from 0 to 100"),
        ('Least="30"', "expected Least_percent"),
    ):
        cfg.write_text(text.replace('Least_percent="30"', wrong))
        assert main(["uxas", "--check"]) == 2
        said = capsys.readouterr().err
        assert words in said
        assert "cfg.xml:2" in said


@pytest.mark.parametrize(
    ("module", "kind", "words"),
    [
        ("", "absent:Service", "ModuleNotFoundError"),
        ("x = 1", "mine:Service", "AttributeError"),
        ("1 / 0", "mine:Service", "ZeroDivisionError"),
        ("class Service:\n    subscribes = ()", "mine:Service", "without start, handle"),
    ],
)
def test_what_is_no_service_is_named(tmp_path: Path, module: str, kind: str, words: str) -> None:
    (tmp_path / "mine.py").write_text(module)
    path = write_cfg(tmp_path, f'<Service Type="{kind}"/>')
    with pytest.raises((BadInput, BadMission)) as caught:
        process(path)
    assert words in str(caught.value)
    assert f"{path}:2" in str(caught.value)


def test_a_message_cannot_name_code_that_the_configuration_does_not(tmp_path: Path) -> None:
    mark = tmp_path / "mark"
    (tmp_path / "other.py").write_text(f"open({str(mark)!r}, 'w').close()")
    one, said = process(write_cfg(tmp_path, '<Service Type="HelloWorld"/>'), virtual=True)
    one.bus.publish(
        lmcp.new("CreateNewService", XmlConfiguration='<Service Type="other:Service"/>'), "afar"
    )
    one.run(0.0)
    assert said.has("unknown service type")
    assert not mark.exists()
    one.close()
