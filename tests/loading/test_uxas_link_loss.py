"""What a UxAS configuration says is flown without ICAROUS is the mission's, refused, or noted; never dropped."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
import yaml

from cratous.services.exporting.exported import exported
from cratous.services.loading import load
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission
from cratous.spec.mission.bridge_times import USUAL, BridgeTimes
from cratous.spec.mission.link_loss import WithoutLink

SERVICE = "IcarousCommunicationService"
FIELD = {"north_m": 300.0, "east_m": 700.0, "alt_m": 320.0}


def folder_of(root: Path, tmp_path: Path, **more: Any) -> tuple[Mission, Path, set[str]]:
    """The crossing with these sections, its UxAS folder, and what that does not say."""
    data = yaml.safe_load((root / "examples/crossing/mission.yaml").read_text())
    path = tmp_path / "mission.yaml"
    path.write_text(yaml.safe_dump({**data, **more}))
    mission = load(path)
    made = exported(mission, "uxas")
    folder = tmp_path / mission.name
    folder.mkdir()
    for name, text in made.files.items():
        (folder / name).write_text(text)
    return mission, folder, {line.partition(":")[0] for line in made.unsaid}


def with_attributes(root: Path, tmp_path: Path, attributes: str) -> Path:
    """The UxAS folder of the crossing with further attributes of the service."""
    _, folder, _ = folder_of(root, tmp_path)
    cfg = folder / "cfg.xml"
    text = cfg.read_text()
    assert f'Type="{SERVICE}"' in text
    cfg.write_text(text.replace(f'Type="{SERVICE}"', f'Type="{SERVICE}" {attributes}'))
    return folder


@pytest.mark.parametrize("choice", ["finish", "loiter", "return"])
def test_the_procedure_comes_back(root: Path, tmp_path: Path, choice: str) -> None:
    mission, folder, unsaid = folder_of(
        root, tmp_path, link_loss={"choice": choice, "after_s": 12.5}
    )
    again = load(folder)
    assert again.link_loss == mission.link_loss
    assert again.bridge_times == USUAL
    assert any("without a word of UxAS for more than 12.5 s" in note for note in again.notes)
    assert not any(item.startswith(("daa", "bridge")) for item in unsaid)


def test_the_place_comes_back(root: Path, tmp_path: Path) -> None:
    to = {"name": "field", "position": FIELD}
    mission, folder, unsaid = folder_of(
        root, tmp_path, link_loss={"choice": "return", "after_s": 5, "to": to}
    )
    again = load(folder)
    assert mission.link_loss is not None
    assert again.link_loss is not None
    assert mission.link_loss.to is not None
    assert again.link_loss.to is not None
    # each mission has its own frame
    start, there = mission.vehicles[0].position, again.vehicles[0].position
    shift = [b - a for a, b in zip(start[:2], there[:2], strict=True)]
    wanted = [a + b for a, b in zip(mission.link_loss.to[:2], shift, strict=True)]
    assert math.dist(again.link_loss.to[:2], wanted) < 0.5
    assert again.link_loss.to.alt_m == pytest.approx(320.0)
    assert "return to the place of LostLinkTo" in " ".join(again.notes)
    assert {item for item in unsaid if item.startswith("daa")} == {"daa.link_loss.name"}


def test_the_silence_alone_is_a_time_of_the_bridge(root: Path, tmp_path: Path) -> None:
    bridge = {"lost_link_after_s": 9.5, "safe_state_after_s": 45, "uxas_route_planner": True}
    _, folder, unsaid = folder_of(root, tmp_path, bridge=bridge)
    again = load(folder)
    assert again.link_loss is None
    assert again.bridge_times == BridgeTimes(lost_link_after_ms=9500)
    assert {item for item in unsaid if item.startswith("bridge")} == {
        "bridge.safe_state_after_ms",
        "bridge.uxas_route_planner",
    }


def test_it_goes_with_live_planning(root: Path, tmp_path: Path) -> None:
    attributes = 'LostLinkAfter_s="9" UseUxasRoutePlanner="true"'
    mission = load(with_attributes(root, tmp_path, attributes))
    assert mission.live_planning
    assert mission.bridge_times.lost_link_after_ms == 9000


def test_a_landing_is_not_said_and_told_so(root: Path, tmp_path: Path) -> None:
    site = {"name": "strip", "position": {"north_m": 0, "east_m": 0}, "radius_m": 60}
    mission, folder, unsaid = folder_of(
        root, tmp_path, link_loss={"choice": "land"}, landing_sites=[site]
    )
    assert mission.link_loss is not None
    assert mission.link_loss.choice is WithoutLink.LAND
    assert load(folder).link_loss is None
    assert any(item.startswith("daa.link_loss") for item in unsaid)


@pytest.mark.parametrize(
    ("attributes", "item"),
    [
        ('LostLink="land"', "LostLink"),
        ('LostLink="loiter" LostLinkAfter_s="0"', "LostLinkAfter_s"),
        ('LostLinkAfter_s="nan"', "LostLinkAfter_s"),
        ('LostLink="loiter" LostLinkTo="45 -120 300"', "LostLinkTo"),
        ('LostLink="return" LostLinkTo="45 -120"', "LostLinkTo"),
        ('LostLink="return" LostLinkTo="45 -120 nan"', "LostLinkTo"),
        ('LostLink="return" LostLinkTo="45 -120 -90000"', "link_loss.to.position"),
    ],
)
def test_wrong_values_are_refused(root: Path, tmp_path: Path, attributes: str, item: str) -> None:
    folder = with_attributes(root, tmp_path, attributes)
    with pytest.raises(BadInput) as wrong:
        load(folder)
    assert item in str(wrong.value)
    assert f"{folder / 'cfg.xml'}:" in str(wrong.value)


def test_without_instances_it_is_noted(root: Path, tmp_path: Path) -> None:
    folder = with_attributes(root, tmp_path, 'LostLink="loiter"')
    cfg = folder / "cfg.xml"
    text = cfg.read_text().replace('NumberOfUAVs="2" VehicleIDs="1 2"', 'NumberOfUAVs="0"')
    cfg.write_text(text)
    mission = load(folder)
    assert mission.instances == ()
    assert mission.link_loss is None
    assert any("LostLink is not used" in note for note in mission.notes)
