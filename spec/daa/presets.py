"""The configurations shipped with the product, as files in `spec/daa/presets`."""

from __future__ import annotations

from pathlib import Path

from cratous.spec.daa.conf_files import Configuration, read
from cratous.spec.errors import BadInput

FOLDER = Path(__file__).resolve().parent / "presets"


def names() -> tuple[str, ...]:
    """The names of the presets."""
    return tuple(sorted(file.stem for file in FOLDER.glob("*.conf")))


def preset(name: str) -> Configuration:
    """The configuration of that name; raises BadInput for an unknown name."""
    if name not in names():
        raise BadInput("there is no such preset", item=name, expected=" or ".join(names()))
    return read(FOLDER / f"{name}.conf")


def named_or_file(name: str) -> Configuration:
    """The preset of that name, or else the configuration in the file of that name."""
    if name in names():
        return preset(name)
    if not Path(name).exists():
        raise BadInput(
            "there is no such file or preset",
            item=name,
            expected=f"a .conf file, or {' or '.join(names())}",
        )
    return read(Path(name))
