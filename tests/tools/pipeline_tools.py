"""What the tests of the pipeline share: a process in virtual time, vehicles and tasks as messages."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from uxas_tools import process, write_cfg

from cratous.bridge import lmcp
from cratous.services.loading.uxas_cfg import PIPELINE


def place(latitude: float, longitude: float = 0.0) -> Any:
    return lmcp.new("Location3D", Latitude=latitude, Longitude=longitude, Altitude=300.0)


def vehicle(number: int, latitude: float = 0.0) -> list[Any]:
    """Configuration and state: 20 m/s, 30 degrees of bank, a camera on a gimbal, heading north."""
    profile = lmcp.new("FlightProfile", Airspeed=20.0, MaxBankAngle=30.0, VerticalSpeed=3.0)
    camera = lmcp.new(
        "CameraConfiguration",
        PayloadID=2,
        MinHorizontalFieldOfView=10.0,
        MaxHorizontalFieldOfView=50.0,
        VideoStreamHorizontalResolution=1000,
        VideoStreamVerticalResolution=500,
    )
    gimbal = lmcp.new(
        "GimbalConfiguration",
        PayloadID=1,
        MinElevation=-90.0,
        MaxElevation=0.0,
        ContainedPayloadList=[2],
    )
    configuration = lmcp.new(
        "AirVehicleConfiguration",
        ID=number,
        NominalSpeed=20.0,
        NominalAltitude=300.0,
        NominalAltitudeType="MSL",
        MinimumSpeed=15.0,
        MaximumSpeed=30.0,
        NominalFlightProfile=profile,
        PayloadConfigurationList=[gimbal, camera],
    )
    state = lmcp.new("AirVehicleState", ID=number, Location=place(latitude), Heading=0.0)
    return [configuration, state]


def must_fly(number: int, latitude: float = 0.02, longitude: float = 0.0, **more: Any) -> Any:
    return lmcp.new("MustFlyTask", TaskID=number, Position=place(latitude, longitude), **more)


def loiter(number: int, latitude: float = 0.02, **more: Any) -> Any:
    action = lmcp.new(
        "LoiterAction",
        LoiterType="Circular",
        Direction="Clockwise",
        Radius=300.0,
        Duration=60_000,
        Airspeed=20.0,
        Location=place(latitude),
    )
    return lmcp.new("LoiterTask", TaskID=number, DesiredAction=action, **more)


def request(*tasks: int, vehicles: tuple[int, ...] = (1,), **more: Any) -> Any:
    return lmcp.new("AutomationRequest", EntityList=list(vehicles), TaskList=list(tasks), **more)


class Rig:
    """A process with some services, in virtual time; everything on the bus is kept by type."""

    def __init__(self, folder: Path, *services: str, entity: int = 100, **attributes: str) -> None:
        """entity: whose process it is; attributes: of services, by type, as text."""
        names = services or PIPELINE
        text = "".join(f'<Service Type="{n}" {attributes.get(n, "")}/>\n' for n in names)
        self.one, self.said = process(write_cfg(folder, text, entity=entity), virtual=True)
        self.all: list[Any] = []
        self.one.bus.tap(self.all.append)

    @property
    def bus(self) -> Any:
        return self.one.bus

    def with_two(self) -> Rig:
        """Itself, told of two vehicles and of two points to fly to."""
        self.tell(*vehicle(1), *vehicle(2, 0.01), must_fly(5), must_fly(6))
        return self

    def tell(self, *bodies: Any, source: str = "test") -> None:
        """Publish messages at once, and run until nothing is queued."""
        for body in bodies:
            self.bus.publish(body, source)
        self.bus.run()

    def wait(self, time_ms: int) -> None:
        """Let virtual time go on."""
        self.bus.run_until(self.bus.now_ms + time_ms)

    def got(self, kind: str, source: str = "") -> list[Any]:
        """The bodies of a type, in order."""
        return [
            e.body
            for e in self.all
            if e.topic.rpartition(".")[2] == kind and source in ("", e.source)
        ]

    def kinds(self) -> list[str]:
        return [e.topic.rpartition(".")[2] for e in self.all]

    def reasons(self, kind: str = "Error") -> list[str]:
        """What the statuses of a kind say."""
        told = [b for b in self.got("ServiceStatus") if b.StatusType.name == kind]
        return [pair.Value for body in told for pair in body.Info if pair.Key == "reason"]


def alone(service: str) -> Any:
    """A fixture: a service by itself, told of two vehicles and of two points to fly to."""

    @pytest.fixture
    def rig(tmp_path: Path) -> Rig:
        return Rig(tmp_path, service).with_two()

    return rig
