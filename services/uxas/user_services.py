"""User-defined services: `Type="module:Class"` in a configuration.

The module is beside the configuration, or importable. Only the configuration file itself can name
one; CreateNewService can create only those named there. How to write one:
docs/guides/own-service.md.
"""

from __future__ import annotations

import importlib
import importlib.util
from pathlib import Path
from typing import Any

from cratous.services.loading.uxas_settings import Configuration
from cratous.services.uxas.own_task import OwnTask
from cratous.services.uxas.registry import KINDS, Kind
from cratous.spec.errors import BadInput

_loaded: dict[str, Kind] = {}


def kind_of(name: str) -> Kind | None:
    """A service type of the registry, or one named by a configuration."""
    return KINDS.get(name) or _loaded.get(name)


def load(config: Configuration, problems: list[BadInput]) -> None:
    """Import the services that a configuration names as `module:Class`."""
    for entry in config.entries:
        if entry.kind == "Service" and ":" in entry.type:
            try:
                _loaded[entry.type] = _kind(entry.type, config.path.parent, entry.where)
            except BadInput as error:
                _loaded.pop(entry.type, None)
                problems.append(error)


def _kind(name: str, folder: Path, where: str) -> Kind:
    module, _, attribute = name.partition(":")
    try:
        made = getattr(_module(module, folder), attribute)
    except Exception as error:  # the user's module may raise anything
        raise BadInput(
            f"the service cannot be loaded: {type(error).__name__}: {error}",
            where=where,
            item="Service.Type",
            expected="module:Class, the module beside the configuration or importable",
            got=name,
        ) from error
    missing = [part for part in ("subscribes", "start", "handle") if not hasattr(made, part)]
    if missing:
        raise BadInput(
            "this is no service",
            where=where,
            item="Service.Type",
            expected="a class with subscribes, start and handle",
            got=f"{name} without {', '.join(missing)}",
        )

    if isinstance(made, type) and issubclass(made, OwnTask):
        try:
            made.check_class()
        except BadInput as error:
            item, expected, got = f"{name}.{error.item}", error.expected, error.got
            raise BadInput(error.what, where=where, item=item, expected=expected, got=got) from None

    def make(host: Any, item: Any, values: dict[str, Any], given: str, number: int) -> Any:
        return made(given.replace(":", "."), values)

    return Kind(dict(getattr(made, "attributes", {})), make)


def _module(name: str, folder: Path) -> Any:
    file = folder / f"{name}.py"
    spec = importlib.util.spec_from_file_location(name, file) if file.is_file() else None
    if spec is None or spec.loader is None:
        return importlib.import_module(name)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
