"""The ledger on disk: a file for each module with kernels and for each folder of theorems.

No file refers to another, so that two branches that change two kernels change different lines. Each record has its
own checksum, which detects manual edits and broken merges; the seal over all records is computed on reading.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cratous.core.kernel.sources import digest
from cratous.core.ledger.key_parts import PROVENANCE
from cratous.core.ledger.package_home import PRODUCT, Home, theorem_home, theorems
from cratous.core.ledger.status import status_of
from cratous.spec.errors import Refused

KINDS = ("kernels", "theorems")
FIELDS = {
    "kernels": frozenset(
        {
            "kind", "implements", "supports", "restates", "checked_by", "rechecked_by", "theorems",
            "against", "proved", "status", "key", "seal",
        }
    ),
    "theorems": frozenset(
        {
            "sentence", "statement", "kernels", "lemmas", "status", "premises", "obligations",
            "assumptions", "seal",
        }
    ),
}  # fmt: skip
"""The exact fields of a record."""


def checksum(name: str, record: dict[str, Any]) -> str:
    """The checksum of one record's contents."""
    body = {key: value for key, value in record.items() if key != "seal"}
    return digest([name, json.dumps(body, sort_keys=True)])


def sealed(name: str, record: dict[str, Any]) -> dict[str, Any]:
    """The record with its checksum."""
    return {**record, "seal": checksum(name, record)}


def read(folder: Path = PRODUCT.records) -> dict[str, Any]:
    """The ledger as data, with the seal over all records; empty if there is none.

    Raises Refused for records that cannot be read or were edited.
    """
    data: dict[str, Any] = {kind: {} for kind in KINDS}
    for file in sorted(folder.glob("*/*.json")):
        where = f"{file.parent.name}/{file.name}"
        try:
            for name, record in json.loads(file.read_text(encoding="utf-8")).items():
                if record["seal"] != checksum(name, record):
                    raise Refused(
                        f"{where} was edited after the prover wrote it: {name}; run `cratous prove`"
                    )
                if name in data[file.parent.name]:
                    raise ValueError(f"two records of {name}")
                _fits(name, file.parent.name, record)
                data[file.parent.name][name] = record
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise Refused(f"{where} cannot be read ({error!r}); run `cratous prove`") from error
    data["seal"] = seal(data)
    return data


def _fits(name: str, kind: str, record: dict[str, Any]) -> None:
    """Raise ValueError for a record of another form, or with a status that its facts do not support."""
    if strange := sorted(FIELDS[kind] ^ set(record)):
        raise ValueError(f"{name}: its fields are of another format: {', '.join(strange)}")
    if kind == "kernels" and (given := status_of(record)) != record["status"]:
        raise ValueError(f"{name}: its status is {record['status']!r}, its facts give {given!r}")


def seal(data: dict[str, Any]) -> str:
    """One checksum over all records; empty if there are none."""
    said = [f"{name} {data[kind][name]['seal']}" for kind in KINDS for name in sorted(data[kind])]
    return digest(said) if said else ""


def texts(data: dict[str, Any], home: Home = PRODUCT) -> dict[str, str]:
    """The ledger as written: the text of each file, by its path in the folder."""
    rows: dict[str, dict[str, Any]] = {}
    for name, record in data["kernels"].items():
        module = name.removeprefix("cratous.core.").rpartition(".")[0]
        rows.setdefault(f"kernels/{module}.json", {})[name] = record
    files = {one: theorems(one) for one in (home, PRODUCT)}
    for name, record in data["theorems"].items():
        rows.setdefault(f"theorems/{_folder(name, home, files)}.json", {})[name] = record
    return {
        place: json.dumps(found, indent=1, sort_keys=True) + "\n"
        for place, found in sorted(rows.items())
    }


def _folder(name: str, home: Home, files: Mapping[Home, dict[str, Path]]) -> str:
    """The folder of a theorem, which names its file of records."""
    whose = theorem_home(name, home, files)
    if whose is None:
        return "theorems"
    file = files[whose][name.rpartition(".")[2]]
    return ".".join(file.relative_to(home.theorems).parts[:-1]) or "theorems"


def differing(new: dict[str, str], folder: Path, *, provenance: bool = True) -> list[str]:
    """The record files whose contents differ from these texts, or that should not exist.

    provenance: whether another solver alone counts as a difference.
    """
    old = {f"{f.parent.name}/{f.name}": f for f in folder.glob("*/*.json")}
    gone = sorted(set(old) - set(new))
    said = str if provenance else _without_provenance
    return gone + [
        place
        for place, text in new.items()
        if place not in old or said(old[place].read_text(encoding="utf-8")) != said(text)
    ]


def _without_provenance(text: str) -> str:
    """The records without the solver's version; unchanged if one was edited manually."""
    rows = json.loads(text)
    for name, record in rows.items():
        if record.pop("seal") != checksum(name, record):
            return text
        for part in PROVENANCE:
            record.get("key", {}).pop(part, None)
    return json.dumps(rows, sort_keys=True)


def solvers(data: dict[str, Any]) -> list[str]:
    """The solvers named by the records of a ledger as `read` returns it."""
    return sorted({record["key"]["solver"] for record in data["kernels"].values()})


def write(new: dict[str, str], folder: Path) -> list[str]:
    """Write these texts atomically, and remove other records; returns the files that differed."""
    found = differing(new, folder)
    for place in found:
        file = folder / place
        if place not in new:
            file.unlink()
            continue
        file.parent.mkdir(parents=True, exist_ok=True)
        part = file.with_suffix(".part")
        part.write_text(new[place], encoding="utf-8")
        part.replace(file)
    return found
