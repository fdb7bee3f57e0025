"""The proof inventory of a report: what the ledger says of the kernels that flew."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.core import ledger
from cratous.core.names import short


def inventory(standing: ledger.Standing) -> dict[str, Any]:
    """Kernels and theorems of the ledger, and what it does not vouch for.

    standing: from `core.ledger.require`, taken before the flight.
    """
    data = ledger.read()
    names = short([*data["kernels"], *(problem.name for problem in standing.problems)])

    def shown(kernels: Iterable[str]) -> list[str]:
        return [names.get(kernel, kernel) for kernel in kernels]

    return {
        "line": standing.line,
        "solver": ledger.solver_version(),
        "seal": data.get("seal", ""),
        "problems": [{"kernel": names[p.name], "what": p.what} for p in standing.problems],
        "kernels": [
            {
                "name": names[name],
                "kind": record["kind"],
                "implements": record["implements"],
                "status": record["status"],
                "theorems": record["theorems"],
                "checked_by": shown(record["checked_by"]),
                "source": record["key"]["source"],
            }
            for name, record in sorted(data["kernels"].items())
        ],
        "theorems": [
            {
                "name": name,
                "sentence": record["sentence"],
                "status": record["status"],
                "kernels": shown(record["kernels"]),
                "obligations": record["obligations"],
                "premises": record["premises"],
                "assumptions": [_text(entry) for entry in record["assumptions"]],
            }
            for name, record in sorted(data["theorems"].items())
        ],
    }


def _text(entry: Any) -> str:
    return entry if isinstance(entry, str) else ": ".join(str(part) for part in entry)
