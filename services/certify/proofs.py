"""The evidence of a report: the kernels that were called, and the ledger's records of exactly these."""

from __future__ import annotations

from typing import Any

from cratous.core import ledger
from cratous.core.kernel.names import short
from cratous.core.kernel.sources import place
from cratous.core.ledger.status import counts

RECORDED, NOT_RECORDED = "recorded", "not recorded"


def inventory(standing: ledger.Standing, calls: dict[str, Any] | None) -> dict[str, Any]:
    """What was called, with its theorems and definitions, and what the ledger does not vouch for.

    standing: from `core.ledger.require`, taken before anything ran; calls: of
    `evidence.Calls.data`, None if nothing was recorded: then no kernel is listed.
    """
    data = _records(standing)
    names = short([*data["kernels"], *(problem.name for problem in standing.problems)])
    kernels = _kernels(calls or {}, data["kernels"])
    return {
        "line": standing.line,
        "solver": ledger.solver_version(),
        "seal": data["seal"],
        "problems": [{"kernel": names[p.name], "what": p.what} for p in standing.problems],
        "calls": NOT_RECORDED if calls is None else RECORDED,
        "kernels": kernels,
        "loops": dict((calls or {}).get("loops", {})),
        "uncounted": list((calls or {}).get("uncounted", [])),
        "theorems": theorems_of(kernels, data["theorems"]),
        "definitions": _definitions(kernels),
    }


_read: tuple[ledger.Standing, dict[str, Any]] | None = None


def _records(standing: ledger.Standing) -> dict[str, Any]:
    """The ledger's records, read once for all flights of the same standing."""
    global _read
    if _read is None or _read[0] is not standing:
        _read = standing, ledger.read()
    return _read[1]


def _kernels(calls: dict[str, Any], known: dict[str, Any]) -> dict[str, Any]:
    """By qualified name: number of calls by way of entry, and the ledger's record."""
    called, within = calls.get("called", {}), calls.get("within", {})
    found = {}
    for name in sorted({*called, *within}):
        record, ways = known.get(name, {}), called.get(name, {})
        whole = record.get("supports", "")
        meant = known.get(whole, record)
        found[name] = {
            "kind": record.get("kind", ""),
            "count": sum(ways.values()),
            "how": dict(ways),
            "within": list(within.get(name, [])),
            "status": record.get("status", "not in the ledger"),
            "theorems": list(record.get("theorems", [])),
            "against": list(meant.get("against", [])),
            "definition": meant.get("implements", ""),
            "step_of": whole,
            "restates": record.get("restates", ""),
            "checked_by": list(record.get("checked_by", [])),
            "rechecked_by": list(record.get("rechecked_by", [])),
            "source": record.get("key", {}).get("source", ""),
        }
    return found


def theorems_of(kernels: dict[str, Any], known: dict[str, Any]) -> dict[str, Any]:
    """The theorems about some kernels, and the lemmas that they depend on."""
    todo = [t for one in kernels.values() for t in (*one["theorems"], *one["against"])]
    found: dict[str, Any] = {}
    while todo:
        name = todo.pop()
        if name not in found and name in known:
            record = known[name]
            found[name] = {
                "sentence": record["sentence"],
                "statement": record["statement"],
                "status": record["status"],
                "kernels": list(record["kernels"]),
                "lemmas": list(record.get("lemmas", [])),
                "obligations": record["obligations"],
                "premises": record["premises"],
                "assumptions": [_text(entry) for entry in record["assumptions"]],
            }
            todo += record.get("lemmas", [])
    return dict(sorted(found.items()))


def _definitions(kernels: dict[str, Any]) -> dict[str, str]:
    """The file of each kernel's definition."""
    found = {}
    for name, one in kernels.items():
        if one["definition"]:
            file = ledger.package(name.split(".")[0]).definition(one["definition"])
            found[one["definition"]] = place(file)
    return dict(sorted(found.items()))


def statuses(proofs: dict[str, Any]) -> dict[str, int]:
    """Number of called kernels by status."""
    return counts([one["status"] for one in proofs["kernels"].values()])


def summary(proofs: dict[str, Any]) -> str:
    """One line that summarises what was called."""
    if proofs["calls"] == NOT_RECORDED:
        return "what was called was not recorded"
    kernels = proofs["kernels"].values()
    entered, inside = sum(k["count"] > 0 for k in kernels), sum(not k["count"] for k in kernels)
    return (
        f"{entered} kernels, folds and drivers were called {sum(k['count'] for k in kernels)} times, "
        f"{inside} more as parts of them; {len(proofs['theorems'])} theorems are about these"
    )


def _text(entry: Any) -> str:
    return entry if isinstance(entry, str) else ": ".join(str(part) for part in entry)
