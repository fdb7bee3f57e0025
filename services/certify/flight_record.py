"""How a mission was flown, as its log records it; what the log does not contain is not checked."""

from __future__ import annotations

from typing import Any

from cratous.core import ledger
from cratous.services.certify.evidence import is_data
from cratous.services.certify.proofs import inventory
from cratous.services.certify.report import PROOFS_KEPT, Flown, environment
from cratous.services.certify.requirements_judged_again import files_in
from cratous.services.certify.running_code import running_code
from cratous.services.logs.records import fingerprint
from cratous.services.requirements.requirement_files import other_libraries
from cratous.services.results.names import FORMER, OWN
from cratous.spec.errors import BadInput

SILENT = "the log does not say (it was made before this was recorded)"


def flown_of(
    meta: dict[str, Any], written: dict[str, Any], where: str
) -> tuple[Flown, dict[str, str], list[str], list[str]]:
    """Returns how it was flown; the report entries that are not checked, with the reason; faults of
    its proofs; and faults of its requirement files.

    meta: of the log; written: the report, trusted only for entries that are not checked.
    """
    unchecked: dict[str, str] = {}

    def entry(name: str, fits: Any, default: Any) -> Any:
        if name in meta:
            if not fits(meta[name]):
                raise _misfit(where, name)
            return meta[name]
        if fits(written.get(name)):
            unchecked[name] = SILENT
            return written[name]
        return default

    command = entry("command", lambda value: isinstance(value, str), "")
    avoidance = entry("avoidance", lambda value: isinstance(value, bool), True)
    around = entry("environment", _is_environment, environment())
    if "code" not in around:
        unchecked["environment.code"] = SILENT
    elif around["code"]["digest"] != running_code()["digest"]:
        unchecked["environment.code"] = "services or bridge are other code than at the flight"
    calls = meta.get("calls")
    if calls is None:
        unchecked["proofs.calls"] = SILENT
    elif not is_data(calls):
        raise _misfit(where, "calls")
    former = written.get("format") == FORMER
    stated = None if former else written.get("proofs")
    proofs, wrong = _proofs(meta.get("proofs", {}), calls, stated, where, unchecked)
    if former:
        unchecked["format"] = unchecked["proofs"] = f"the report is one of {FORMER}"
        wrong = []
    own, lacking = files_in(written, meta)
    if others := other_libraries(own):
        unchecked[f"{OWN}.files"] = "; ".join(others)
    return Flown(command, avoidance, proofs, around, own), unchecked, wrong, lacking


def _is_environment(data: Any) -> bool:
    return (
        isinstance(data, dict)
        and set(data) - {"code"} == {"python", "system", "packages"}
        and _is_code(data.get("code"))
        and isinstance(data["python"], str)
        and isinstance(data["system"], str)
        and isinstance(data["packages"], dict)
        and all(isinstance(version, str) for version in data["packages"].values())
    )


def _is_code(data: Any) -> bool:
    """Whether the data has the form of `running_code`, or is absent, as in logs from before it was recorded."""
    if data is None:
        return True
    return (
        isinstance(data, dict)
        and set(data) == {"digest", "running", "release"}
        and all(isinstance(text, str) for text in data.values())
    )


def _proofs(
    kept: Any, calls: dict[str, Any] | None, written: Any, where: str, unchecked: dict[str, str]
) -> tuple[dict[str, Any], list[str]]:
    """The flight's proof inventory, as far as the log or the current ledger determines it."""
    if not isinstance(kept, dict) or not isinstance(kept.get("problems", []), list):
        raise _misfit(where, "proofs")
    if not all(
        isinstance(p, dict) and set(p) == {"kernel", "what"} for p in kept.get("problems", [])
    ):
        raise _misfit(where, "proofs.problems")
    standing = ledger.require(allow_unproved=bool(kept.get("problems")))
    made = inventory(standing, calls)
    today = {**made, **{key: kept[key] for key in PROOFS_KEPT if key in kept}}
    if made["seal"] == kept.get("seal"):
        for key in PROOFS_KEPT:
            if key not in kept and isinstance(written, dict) and isinstance(written.get(key), str):
                today[key] = written[key]
                unchecked[f"proofs.{key}"] = SILENT
        found = fingerprint(today)
        if calls is not None and kept.get("sha256", found) != found:
            text = f"SHA-256 of the log {kept['sha256']}, of what it recorded {found}"
            return today, [f"proofs: not those of the flight ({text})"]
        return today, []
    if "sha256" in kept:
        found = fingerprint(written)
        if found == kept["sha256"] and isinstance(written, dict):
            unchecked["proofs.seal"] = "the ledger is another than at the flight"
            return written, []
        text = f"SHA-256 of the log {kept['sha256']}, of what is written {found}"
        return today, [f"proofs: not the inventory of the flight ({text})"]
    if not _has_form(written, made):
        return today, ["proofs: not of the form of an inventory"]
    unchecked["proofs"] = "the ledger is another than at the flight, and " + SILENT
    return {**written, "problems": kept.get("problems", [])}, []


def _has_form(value: Any, like: Any) -> bool:
    """Whether a value has the keys and types of another; in a list each entry those of the first."""
    if isinstance(like, dict):
        return (
            isinstance(value, dict)
            and set(value) == set(like)
            and all(_has_form(value[key], like[key]) for key in like)
        )
    if isinstance(like, list):
        return isinstance(value, list) and all(_has_form(v, like[0]) for v in value if like)
    return type(value) is type(like)


def _misfit(where: str, name: str) -> BadInput:
    return BadInput(
        "the log's meta does not fit", where=where, item=f"meta.{name}",
        expected="what cratous run writes", got="something else",
    )  # fmt: skip
