"""Missions from files: our own YAML, or a UxAS folder or configuration as it is."""

from __future__ import annotations

from pathlib import Path

from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission


def load(path: str | Path, seed: int = 0, request: int = 1) -> Mission:
    """The mission at a path: a YAML file, a UxAS cfg XML, or a folder with either.

    seed: 0 is the mission as written, N > 0 its N-th variant (YAML missions only); request: which
    of the AutomationRequests of a UxAS configuration, in the order in which they are sent.
    Raises BadInput with file, item, expected and got.
    """
    path = Path(path)
    if not path.exists():
        raise BadInput(
            "there is no such file",
            where=str(path),
            expected="a mission file (.yaml), a UxAS configuration (.xml) or a folder with one",
        )
    if path.is_dir() and (path / "mission.yaml").is_file():
        path = path / "mission.yaml"
    if path.is_dir() or path.suffix.lower() == ".xml":
        from cratous.services.loading.uxas import load_uxas

        if seed:
            raise BadInput(
                "a UxAS configuration has no variants",
                where=str(path),
                expected="--seed 0",
                got=f"--seed {seed}",
            )
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
    """How many AutomationRequests a UxAS folder or configuration sends; 1 for a mission file."""
    path = Path(path)
    if (path.is_dir() and not (path / "mission.yaml").is_file()) or path.suffix.lower() == ".xml":
        from cratous.services.loading.uxas import requests_of
        from cratous.services.loading.uxas_cfg import read_all

        return len(requests_of(read_all(path)))
    return 1
