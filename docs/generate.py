"""Writes the generated documents: `docs/proof-inventory.md` from the ledger and the re-check,
`docs/mutation.md` from `proofs/mutation.json`; `docs/services.md` (see `services_table.py`).

The second solver's verdicts and the effort come from `proofs/recheck.json`, which
`cratous prove --recheck` writes; a theorem that it does not know is shown as not re-checked.

`python docs/generate.py --check` writes nothing and fails if a document is not up to date.
"""

from __future__ import annotations

import sys
from pathlib import Path

import services_table

from cratous.core import ledger
from cratous.core.names import short
from cratous.core.whole_file import write_atomically
from cratous.proofs import mutation_record, recheck
from cratous.proofs.mutation_keys import Keys

FOLDER = Path(__file__).resolve().parent


def inventory() -> str:
    """Every theorem with its sentence, then every kernel, fold and driver with what checks it."""
    data, second = ledger.read(), recheck.read()
    theorems, kernels = data["theorems"], data["kernels"]
    names = short(kernels)
    assumed = sum(len(t["assumptions"]) for t in theorems.values())
    obligations = sum(t["obligations"] for t in theorems.values())
    known = second["theorems"]
    verdicts = {n: known[n]["cvc5"] if n in known else "not re-checked" for n in theorems}
    confirmed = sum(verdict == "confirmed" for verdict in verdicts.values())
    rows = second["obligations"].values()
    good = sum(row["cvc5"] == "confirmed" for row in rows)
    solver = second["solver"] or "the second solver"
    lines = [
        "# Proof inventory",
        "",
        "Generated from `core/ledger.json` and `proofs/recheck.json` by `make docs`; do not edit.",
        "",
        f"{len(theorems)} theorems, {obligations} obligations, {assumed} assumptions, "
        f"{data.get('solver', 'no solver')}. All theorems are over the reals (or 64-bit "
        "integers); a verdict on doubles is exact where the same function is evaluated on "
        "rationals.",
        "",
        f"{solver} confirms {confirmed} of {len(theorems)} theorems "
        f"({good} of {len(rows)} obligations). No answer is no contradiction: it did not decide "
        "within its budget. Effort is z3's, in thousands of its own steps.",
        "",
        "## Theorems",
        "| theorem | sentence | about | obligations | effort | second solver |",
        "|---|---|---|---|---|---|",
    ]
    for name, theorem in sorted(theorems.items()):
        about = ", ".join(f"`{names[kernel]}`" for kernel in theorem["kernels"])
        spent = f"{known[name]['z3_effort'] / 1000:.0f}" if name in known else "-"
        lines.append(
            f"| `{name}` | {theorem['sentence']} | {about} | {theorem['obligations']} "
            f"| {spent} | {verdicts[name]} |"
        )
    for theorem_name, theorem in sorted(theorems.items()):
        for condition, owner, reason in theorem["assumptions"]:
            lines.append(f"\n**Assumed** in `{theorem_name}` by {owner}: {condition} ({reason})")
    waiting = [row for row in rows if row["cvc5"] != "confirmed"]
    if waiting:
        lines += ["", "## Obligations that the second solver does not confirm"]
        lines += [f"- {row['cvc5']}: {'; '.join(row['of'])}" for row in waiting]
    lines += ["", "## Kernels, folds and drivers", "| name | kind | definition | stands on |"]
    lines.append("|---|---|---|---|")
    for name, kernel in sorted(kernels.items()):
        stands = kernel["theorems"] or [f"checked by {names[k]}" for k in kernel["checked_by"]]
        definition = f"`{kernel['implements']}`" if kernel["implements"] else "search or map"
        if kernel["supports"]:
            definition = f"a step of `{names[kernel['supports']]}`"
        if kernel["restates"]:
            definition += f", restated: {kernel['restates']}"
        lines.append(f"| `{names[name]}` | {kernel['kind']} | {definition} | {', '.join(stands)} |")
    return "\n".join(lines) + "\n"


def mutation() -> str:
    """What mutants came of every kernel and definition; what is no longer up to date is named."""
    return mutation_record.document(mutation_record.read(), Keys())


def main() -> int:
    """Write, or with --check compare."""
    wrong = 0
    pages = {
        "proof-inventory.md": inventory,
        "mutation.md": mutation,
        "services.md": services_table.document,
    }
    for name, make in pages.items():
        file, text = FOLDER / name, make()
        if "--check" in sys.argv:
            good = file.is_file() and file.read_text(encoding="utf-8") == text
            print(f"{name}: {'up to date' if good else 'run `make docs`'}")
            wrong += not good
        else:
            write_atomically(file, text)
            print(f"{name}: {len(text.splitlines())} lines")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
