"""Writes the generated documents: `docs/proof-inventory.md` from the ledger.

`python docs/generate.py --check` writes nothing and fails if a document is not up to date.
"""

from __future__ import annotations

import sys
from pathlib import Path

from cratous.core import ledger

FILE = Path(__file__).resolve().parent / "proof-inventory.md"


def inventory() -> str:
    """Every theorem with its sentence, then every kernel, fold and driver with what checks it."""
    data = ledger.read()
    theorems, kernels = data["theorems"], data["kernels"]
    assumed = sum(len(t["assumptions"]) for t in theorems.values())
    obligations = sum(t["obligations"] for t in theorems.values())
    lines = [
        "# Proof inventory",
        "",
        "Generated from `core/ledger.json` by `make docs`; do not edit.",
        "",
        f"{len(theorems)} theorems, {obligations} obligations, {assumed} assumptions, "
        f"{data['solver']}. All theorems are over the reals (or 64-bit integers); a verdict on "
        "doubles is exact where the same function is evaluated on rationals.",
        "",
        "## Theorems",
        "| theorem | sentence | about | obligations |",
        "|---|---|---|---|",
    ]
    for name, theorem in sorted(theorems.items()):
        about = ", ".join(f"`{kernel}`" for kernel in theorem["kernels"])
        lines.append(f"| `{name}` | {theorem['sentence']} | {about} | {theorem['obligations']} |")
    lines += ["", "## Kernels, folds and drivers", "| name | kind | definition | stands on |"]
    lines.append("|---|---|---|---|")
    for name, kernel in sorted(kernels.items()):
        stands = kernel["theorems"] or [f"checked by {k}" for k in kernel["checked_by"]]
        definition = f"`{kernel['implements']}`" if kernel["implements"] else "search or map"
        lines.append(f"| `{name}` | {kernel['kind']} | {definition} | {', '.join(stands)} |")
    return "\n".join(lines) + "\n"


def main() -> int:
    """Write, or with --check compare."""
    text = inventory()
    if "--check" in sys.argv:
        good = FILE.is_file() and FILE.read_text(encoding="utf-8") == text
        print(f"{FILE.name}: {'up to date' if good else 'run `make docs`'}")
        return 0 if good else 1
    FILE.write_text(text, encoding="utf-8")
    print(f"{FILE.name}: {len(text.splitlines())} lines")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
