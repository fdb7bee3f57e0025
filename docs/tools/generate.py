"""Writes the documents generated from the records, into `docs/generated/` or the folder given.

`proof-inventory.md` from the ledger and the re-check, `mutation.md` from the record of mutants, `services.md` from
the registry of services and the tests (`services_table.py`). They are not kept in the repository, where any two
branches would both rewrite them.

The second solver's verdicts and the effort come from `proofs/recheck.json`, which `cratous prove --recheck` writes; a
theorem that is not in it is shown as not re-checked.
"""

from __future__ import annotations

import sys
from pathlib import Path

import services_table

from cratous.core import ledger
from cratous.core.files.whole_file import write_atomically
from cratous.core.kernel.names import short
from cratous.core.ledger.status import counts, in_words
from cratous.proofs import recheck
from cratous.proofs.mutation import record as mutation_record
from cratous.proofs.mutation.keys import Keys

FOLDER = Path(__file__).resolve().parents[1] / "generated"


def inventory() -> str:
    """Every theorem with its sentence, then every kernel, fold and driver with the evidence for it."""
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
        "Generated from `core/ledger/records/` and `proofs/recheck.json` by `make docs`.",
        "",
        f"{len(theorems)} theorems, {obligations} obligations, {assumed} assumptions, "
        f"{ledger.solver_version()}. All theorems are over the reals (or 64-bit "
        "integers); a verdict on doubles is exact where the same function is evaluated on "
        "rationals.",
        "",
        f"{solver} confirms {confirmed} of {len(theorems)} theorems "
        f"({good} of {len(rows)} obligations). No answer is no contradiction: it did not decide "
        "within its budget. Effort is z3's, in thousands of its own steps.",
        "",
        "## Theorems",
        "Under each sentence of an author stands one that is made from what the theorem states.",
        "",
        "| theorem | sentence | about | obligations | effort | second solver |",
        "|---|---|---|---|---|---|",
    ]
    for name, theorem in sorted(theorems.items()):
        about = ", ".join(f"`{names[kernel]}`" for kernel in theorem["kernels"])
        spent = f"{known[name]['z3_effort'] / 1000:.0f}" if name in known else "-"
        lines.append(
            f"| `{name}` | {theorem['sentence']}<br>*{_cell(theorem['statement'])}* "
            f"| {about} | {theorem['obligations']} "
            f"| {spent} | {verdicts[name]} |"
        )
    for theorem_name, theorem in sorted(theorems.items()):
        for condition, owner, reason in theorem["assumptions"]:
            lines.append(f"\n**Assumed** in `{theorem_name}` by {owner}: {condition} ({reason})")
    waiting = [row for row in rows if row["cvc5"] != "confirmed"]
    if waiting:
        lines += ["", "## Obligations that the second solver does not confirm"]
        lines += [f"- {row['cvc5']}: {'; '.join(row['of'])}" for row in waiting]
    lines += ["", "## Kernels, folds and drivers", ""]
    said = counts([kernel["status"] for kernel in kernels.values()])
    lines += ["; ".join(f"{number} {status}" for status, number in said.items()) + ".", ""]
    lines += ["| name | kind | definition | status | theorems, or kernels that decide in it |"]
    lines.append("|---|---|---|---|---|")
    for name, kernel in sorted(kernels.items()):
        stands = kernel["theorems"] or [names[one] for one in kernel["checked_by"]]
        definition = f"`{kernel['implements']}`" if kernel["implements"] else "search or map"
        if kernel["supports"]:
            definition = f"a step of `{names[kernel['supports']]}`"
        if kernel["restates"]:
            definition += f", restated: {kernel['restates']}"
        lines.append(
            f"| `{names[name]}` | {kernel['kind']} | {definition} | {in_words(kernel, names)} "
            f"| {', '.join(stands)} |"
        )
    return "\n".join(lines) + "\n"


def _cell(text: str) -> str:
    """Text for a table cell, with special characters escaped."""
    return text.replace("|", "\\|").replace("*", "\\*").replace("_", "\\_").replace("<", "&lt;")


def mutation() -> str:
    """The results of mutation for every kernel and definition; stale results are marked."""
    return mutation_record.document(mutation_record.read(), Keys())


def main(folder: Path) -> None:
    """Write all documents."""
    folder.mkdir(parents=True, exist_ok=True)
    pages = {
        "proof-inventory.md": inventory,
        "mutation.md": mutation,
        "services.md": services_table.document,
    }
    for name, make in pages.items():
        text = make()
        write_atomically(folder / name, text)
        print(f"{folder.name}/{name}: {len(text.splitlines())} lines")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
