"""Loads missions from files: the CRATOUS YAML format, or an unmodified UxAS folder, configuration
or AMASE scenario.
"""

from __future__ import annotations

from pathlib import Path

from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission


def load(path: str | Path, seed: int = 0, request: int = 1) -> Mission:
    """The mission at a path: a YAML file, a UxAS cfg XML, a folder with either, or an AMASE
    scenario XML.

    seed: 0 is the mission as written, N > 0 its N-th variant (YAML missions only); request: number
    of the AutomationRequest of a UxAS configuration or scenario, in sending order. Raises BadInput
    with file, item, expected and got.
    """
    path = Path(path)
    if not path.exists():
        raise BadInput(
            "there is no such file",
            where=str(path),
            expected="a mission file (.yaml), a UxAS configuration or AMASE scenario (.xml) or a folder with one",
        )
    if path.is_dir() and (path / "mission.yaml").is_file():
        path = path / "mission.yaml"
    if path.is_dir() or path.suffix.lower() == ".xml":
        from cratous.services.loading.amase import is_scenario, load_amase
        from cratous.services.loading.uxas import load_uxas

        if seed:
            raise BadInput(
                "a UxAS configuration has no variants",
                where=str(path),
                expected="--seed 0",
                got=f"--seed {seed}",
            )
        if path.is_file() and is_scenario(path):
            return load_amase(path, request)
        return load_uxas(path, request)
    if path.suffix.lower() in (".yaml", ".yml"):
        if request != 1:
            raise BadInput(
                "a mission file is one request",
                where=str(path),
                expected="--request 1",
                got=f"--request {request}",
            )
        from cratous.services.loading.yaml_mission import load as load_yaml

        return load_yaml(path, seed)
    raise BadInput(
        "not a mission file",
        where=str(path),
        expected="a name that ends in .yaml, .yml or .xml, or a folder",
        got=path.suffix or "none",
    )


def count_requests(path: str | Path) -> int:
    """How many AutomationRequests a UxAS folder, configuration or scenario sends; 1 for a mission file."""
    path = Path(path)
    if (path.is_dir() and not (path / "mission.yaml").is_file()) or path.suffix.lower() == ".xml":
        from cratous.services.loading.amase import count_scenario_requests, is_scenario
        from cratous.services.loading.uxas_cfg import read_all
        from cratous.services.loading.uxas_requests import requests_of

        if path.is_file() and is_scenario(path):
            return count_scenario_requests(path)
        return len(requests_of(read_all(path)))
    return 1
