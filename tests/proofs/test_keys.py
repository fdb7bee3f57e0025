"""Keys by definition: a change makes stale what reaches it, and nothing else."""

from __future__ import annotations

import ast
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from cratous.core import ledger
from cratous.core.kernel.sources import ROOT, reached
from cratous.core.ledger import key_parts
from cratous.core.ledger import keys as keys_module
from cratous.core.ledger.definition_hash import Walk
from cratous.core.ledger.key_parts import MISSING, PROVER, READINGS, REMEMBERS
from cratous.core.ledger.keys import Keys
from cratous.core.ledger.lookup_exceptions import EXCUSED, EXCUSES

ENTRIES = ledger.load_all()
DATA = ledger.read()
HUB = "cratous.core.well_clear.now.horizontal_decision"
MORE = "\n\ndef nothing_uses_this(x: float) -> float:\n    return x + 1\n"


def _all(keys: Keys) -> dict[str, dict[str, str]]:
    return {
        name: keys.of(entry, DATA["kernels"][name]["theorems"], DATA["theorems"])
        for name, entry in ENTRIES.items()
    }


@pytest.fixture(scope="module")
def keys() -> Keys:
    return Keys()


@pytest.fixture(scope="module")
def before(keys: Keys) -> dict[str, dict[str, str]]:
    return _all(keys)


Edit = tuple[str, str, str]
Stale = Callable[..., set[str]]


def edited(texts: dict[Path, bytes], edit: Edit) -> tuple[Path, bytes]:
    """A file, and what it says after one edit more."""
    place, old, new = edit
    file = ROOT / place
    text = texts.get(file, file.read_bytes()).decode()
    assert old in text, f"{old!r} is not in {place}: this case needs an update"
    return file, (text.replace(old, new, 1) if old else text + new).encode()


@pytest.fixture(scope="module")
def stale(before: dict[str, dict[str, str]]) -> Stale:
    def count(*edits: Edit) -> set[str]:
        """Names of the entries that are stale where files say `new` in the place of `old`."""
        texts = dict[Path, bytes]()
        for edit in edits:
            texts |= [edited(texts, edit)]
        now = _all(Keys(edits=texts))
        return {name for name in ENTRIES if now[name] != before[name]}

    return count


def _added(place: str) -> Edit:
    return place, "", MORE  # at its end


NOTHING = {
    "a function more beside the claim": _added("proofs/engine/claim.py"),
    "a method more of the claim": (
        "proofs/engine/claim.py", "    def implies(self",
        "    def unheard_of(self) -> int:\n        return 1\n\n    def implies(self"),
    "a function more in the prover": _added("proofs/engine/prover.py"),
    "a helper more for theorems": _added("proofs/statements/relations.py"),
    "a method of proof more": _added("proofs/methods/rounding.py"),
    "a definition more": _added("spec/well_clear.py"),
    "a kernel's helper more": _added("core/well_clear/now.py"),
    "a reading more": _added("core/readings/machine/compiled.py"),
    "a comment in the prover": (
        "proofs/engine/prover.py", "def _maker(", "# by its logic\ndef _maker("),
    "a docstring in the prover": (
        "proofs/engine/prover.py", '"""The answer of the first solver that decides', '"""What the first solver said that decides'),
    "what is told of a refutation": (
        "proofs/engine/counterexample.py", "def story(", "def _more() -> int:\n    return 2\n\n\ndef story("),
    "how a refutation is told": (
        "proofs/engine/counterexample.py", "def story(claim: Claim, model: Model) -> list[str]:",
        "def story(claim: Claim, model: Model, more: int = 1) -> list[str]:"),
    "how answers are remembered": (
        "proofs/engine/cache.py", "self.hits += 1", "self.hits += 2"),
    "how theorems are remembered": (
        "proofs/ledger/proof_recall.py", "if file.is_file():", "if file.exists():"),
    "how results are printed": _added("proofs/ledger/report_formats.py"),
    "a theorem about another kernel": _added("proofs/theorems/well_clear/violation_is_symmetric.py"),
}  # fmt: skip


def test_what_no_proof_uses_makes_nothing_stale(stale: Stale) -> None:
    """All at once; where that makes something stale, each alone, so that it is named."""
    if stale(*NOTHING.values()):
        assert {what: found for what, edit in NOTHING.items() if (found := stale(edit))} == {}
        raise AssertionError("no edit alone makes anything stale, all together do")


EVERYTHING = {
    "the prover": ("proofs/engine/prover.py", '"unsat": "proved"', '"sat": "proved"'),
    "the lifter": ("proofs/engine/symbolic.py", "lambda x, y: x <= y", "lambda x, y: x < y"),
    "a way of solving": ("proofs/engine/solver_order.py", "SEEDS = (0, 1, 2)", "SEEDS = (0, 1)"),
    "what a claim owes": ("proofs/engine/claim.py", "given = (*self.premises, *self.facts)",
                          "given = (*self.premises, *self.facts, *self.goals)"),
    "how a kernel is compiled": ("core/readings/machine/compiled.py", "range(out.size)", "range(0)"),
    "how a kernel is marked": ("core/kernel/__init__.py", "old is not None and not", "old is None and not"),
    "a constant of the float filter": (
        "core/readings/exact/error_bounds.py", "Fraction(1, 2**53)", "Fraction(1, 2**54)"),
    "the exact reading": ("core/readings/exact/__init__.py", "FEW = 64", "FEW = 65"),
    "what a residue may decide": ("core/readings/exact/residues.py", "e + 126", "e + 127"),
    "what a pair leaves out": (
        "core/readings/exact/double_pairs.py", "abs({gap.low}) + {gap.left}", "abs({gap.low})"),
    "the gate": ("core/ledger/__init__.py", 'if not record["proved"]:', "if not record:"),
    "the ledger's writer": ("proofs/ledger/__init__.py", '"proved": good,', '"proved": True,'),
}  # fmt: skip


def test_what_all_proofs_stand_on_makes_all_of_them_stale(stale: Stale) -> None:
    assert stale(EVERYTHING["the prover"]) == set(ENTRIES)


@pytest.mark.parametrize("what", sorted(EVERYTHING))
def test_what_all_proofs_stand_on_is_in_what_all_keys_share(what: str, keys: Keys) -> None:
    edits = dict([edited({}, EVERYTHING[what])])
    assert Keys(edits=edits).shared != keys.shared


def test_a_hub_makes_stale_what_reaches_it(keys: Keys, stale: Stale) -> None:
    found = stale(("core/well_clear/now.py", "    if ss <= dd:", "    if 0 + ss <= dd:"))
    calling = {n for n, entry in ENTRIES.items() if HUB in reached(entry.function)}
    theorems = {n for n in DATA["theorems"] if HUB in keys.functions(n)}
    about = {n for n in ENTRIES if theorems & set(DATA["kernels"][n]["theorems"])}
    assert HUB in calling
    assert calling <= found
    assert about <= found
    checked = {n for n in ENTRIES if calling & set(DATA["kernels"][n]["checked_by"])}
    assert found == calling | about | checked
    assert 5 < len(found) < 60, len(found)


def test_a_way_of_stating_makes_stale_what_theorems_state_so(stale: Stale) -> None:
    """`Claim.congruence` is used by some theorems, not by the prover itself."""
    found = stale(
        (
            "proofs/engine/claim.py",
            "stub = self.stubs[function]\n        fact",
            "stub = None\n        fact",
        )
    )
    users = {
        f.stem for f in (ROOT / "proofs/theorems").rglob("*.py") if "c.congruence(" in f.read_text()
    }
    assert users
    assert 0 < len(found) < len(ENTRIES) / 2


def test_a_definition_makes_stale_what_it_is_the_meaning_of(stale: Stale) -> None:
    found = stale(
        (
            "spec/constraint_rows.py",
            "NOT_BEFORE, NOT_AFTER = 1, 2, 3, 4, 5, 6",
            "NOT_BEFORE, NOT_AFTER = 2, 1, 3, 4, 5, 6",
        )
    )
    assert "cratous.core.schedule.rows.row_holds" in found
    assert len(found) < 40


# -- moves -----------------------------------------------------------------------------------
def test_a_theorem_keeps_its_meaning_where_what_it_uses_moves(keys: Keys) -> None:
    """The helpers of `proofs/methods/sweeping.py` in a module of another name."""
    old, new = ROOT / "proofs/methods/sweeping.py", ROOT / "proofs/methods/moved/swept.py"
    users = [
        f for f in (ROOT / "proofs/theorems").rglob("*.py") if "methods.sweeping" in f.read_text()
    ]
    assert users
    edits = {f: f.read_bytes().replace(b"methods.sweeping", b"methods.moved.swept") for f in users}
    moved = Keys(edits={**edits, new: old.read_bytes(), old: b""})
    for file in users:
        name = ledger.theorem_name(file, ledger.PRODUCT.theorems)
        assert moved.theorem(name) == keys.theorem(name) != MISSING


def test_a_kernel_keeps_its_source_in_a_module_of_another_name(keys: Keys) -> None:
    old, new = ROOT / "core/authority/gate.py", ROOT / "core/authority/moved.py"
    moved = Keys(edits={new: old.read_bytes()})
    one = keys.function("cratous.core.authority.gate.gate_takeover")
    other = moved.function("cratous.core.authority.moved.gate_takeover")
    assert one is not None
    assert other is not None
    assert one.digest == other.digest


def test_two_lemmas_do_not_change_places_unseen(keys: Keys) -> None:
    """The lemmas that a theorem names count in their order, not only as a set."""
    name, (first, second), file, text = next(
        (n, w.strings[:2], file, text)
        for n, w in _statements(keys)
        if len(w.strings) > 1 and (file := ledger.theorem_file(n, ledger.PRODUCT)) is not None
        and all(f'"{one}"' in (text := file.read_text()) for one in w.strings[:2])
    )  # fmt: skip
    swapped = text.replace(first, "@").replace(second, first).replace("@", second)
    assert swapped != text
    assert Keys(edits={file: swapped.encode()}).theorem(name) != keys.theorem(name)


MAKERS = {
    "core.kernel.fold": "registers the fold, which has a key of its own",
    "core.readings.exact.folds.folded": "makes a reading of a fold that it is given",
    "proofs.system_search.certificate_faults._as_if": "makes a broken design for the search",
    "proofs.system_search.faults._same_epoch": "makes a broken design for the search",
    "spec.daa.parameters._key": "makes a record from what it is given",
}
"""Functions of ours that are called when a module is read, to make a value."""


def test_values_of_modules_are_made_by_functions_that_change_nothing_else(keys: Keys) -> None:
    """A call in an assignment counts for the name alone: were it to change others, a key would not see."""
    called = set()
    for module in keys.tree.every_module:
        file = keys.tree.file(module)
        body = ast.parse(file.read_text(encoding="utf-8")).body if file else []
        values = [n.value for n in body if isinstance(n, ast.Assign | ast.AnnAssign) and n.value]
        for node in (inner for value in values for inner in ast.walk(value)):
            name = ast.unparse(node.func) if isinstance(node, ast.Call) else ""
            if name.replace(".", "").isidentifier():
                for place in keys.tree.meant(module, tuple(name.split("."))):
                    if not isinstance(place, str) and keys.tree.unit(place).kind == "function":
                        called.add(keys.name(place).removeprefix("cratous."))
    assert called == set(MAKERS)


# -- what cannot be followed -----------------------------------------------------------------
def _statements(keys: Keys) -> list[tuple[str, Walk]]:
    found = [(name, keys.statement(name)) for name in sorted(DATA["theorems"])]
    return [(name, one) for name, one in found if one is not None]


def _walks(keys: Keys) -> list[Walk]:
    for entry in ENTRIES.values():
        keys.source(entry)
        keys.definition(entry)
    functions = list(keys._walks.values())
    return [keys.readings, keys.prover, *functions, *(one for _, one in _statements(keys))]


def test_no_key_depends_on_a_look_up_that_cannot_be_followed(keys: Keys) -> None:
    found = {(keys.name(p), *sorted(asks)) for one in _walks(keys) for p, asks in one.asks.items()}
    assert found == set()


def wrong_excuses(keys: Keys, excuses: dict[str, tuple[tuple[str, ...], str]]) -> list[str]:
    """Rows that name nothing that some key meets, or a way of looking up that is not there."""
    met = {keys.name(place): place for one in _walks(keys) for place in one.places}
    found = []
    for name, (words, reason) in excuses.items():
        place = met.get(f"cratous.{name}")
        if place is None:
            found.append(f"{name} is met by no key")
        else:
            found += [f"{name} has no {w}" for w in words if w not in keys.tree.unit(place).asks]
        if len(reason) < 20:
            found.append(f"{name} has no reason")
    return found


def test_each_excuse_names_something_real(keys: Keys) -> None:
    assert wrong_excuses(keys, EXCUSES) == []
    assert len(EXCUSED) == len(EXCUSES)


def test_a_wrong_excuse_is_named(keys: Keys) -> None:
    reason = "it was looked at by somebody"
    rows = {
        "core.kernel.entry_of": (("REGISTRY", "exec"), reason),
        "core.kernel.nowhere": (("exec",), reason),
        "services.loading.load": (("open",), reason),
        "core.kernel._register": (("REGISTRY",), ""),
    }
    assert wrong_excuses(keys, rows) == [
        "core.kernel.entry_of has no exec",
        "core.kernel.nowhere is met by no key",
        "services.loading.load is met by no key",
        "core.kernel._register has no reason",
    ]


def _asked_of_readings() -> set[str]:
    """Functions and classes of the readings that modules of core, services and bridge import."""
    found = set()
    for part in ("core", "services", "bridge"):
        for file in sorted((ROOT / part).rglob("*.py")):
            if file.is_relative_to(ROOT / "core" / "readings"):
                continue
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                module = node.module or "" if isinstance(node, ast.ImportFrom) else ""
                if module.startswith(("cratous.core.readings", "cratous.core.compiled")):
                    found |= {f"{module}.{alias.name}" for alias in node.names}
    return found


def test_every_reading_that_is_called_from_elsewhere_is_part_of_each_key(keys: Keys) -> None:
    asked = {name: keys.places(name) for name in _asked_of_readings()}
    code = {n: p for n, p in asked.items() if p and keys.tree.unit(p[0]).kind != "value"}
    assert len(code) > 6
    assert [n for n, places in code.items() if not set(places) <= set(keys.readings.places)] == []


def test_each_lemma_that_was_used_is_named_in_some_text(keys: Keys) -> None:
    """Or in a text that is put together of written parts; no proof is recalled without."""
    unseen = {n: set(r["lemmas"]) - keys.lemmas(n) for n, r in DATA["theorems"].items()}
    assert {name: lemmas for name, lemmas in unseen.items() if lemmas} == {}


@pytest.mark.parametrize("name", [*READINGS, *PROVER, *REMEMBERS])
def test_each_root_and_each_border_is_there(name: str, keys: Keys) -> None:
    assert keys.places(f"cratous.{name}")


def test_each_border_is_met_by_the_prover(keys: Keys) -> None:
    met = {keys.name(place) for place in keys.prover.edge}
    assert [name for name in REMEMBERS if f"cratous.{name}" not in met] == []


def test_a_root_that_is_not_there_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(keys_module, "READINGS", ("core.kernel.nowhere",))
    with pytest.raises(LookupError, match="nowhere"):
        _ = Keys().readings


def test_what_is_not_there_is_missing_and_never_vouched_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    real = Keys.source
    monkeypatch.setattr(Keys, "source", lambda self, e: MISSING if e.name == HUB else real(self, e))
    monkeypatch.setattr(ledger, "read", lambda folder: _recorded_as_missing())
    problems = {p.name: p.what for p in ledger.check().problems}
    assert "its source" in problems[HUB]


def _recorded_as_missing() -> dict:
    record = DATA["kernels"][HUB]
    row = {**record, "key": {**record["key"], "source": MISSING}}
    return {**DATA, "kernels": {**DATA["kernels"], HUB: row}}


@pytest.mark.parametrize("name", ["z3-solver", "numba", "llvmlite", "numpy"])
def test_another_version_of_a_tool_is_noticed(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    real, other = key_parts.version, Keys()
    other.shared  # noqa: B018  (read before the version changes)
    monkeypatch.setattr(key_parts, "version", lambda n: "9.9" if n == name else real(n))
    now = Keys().shared
    changed = {part for part in now if now[part] != other.shared[part]}
    assert changed == {"solver" if name == "z3-solver" else "flags"}


def test_no_key_knows_the_machine(keys: Keys, tmp_path: Path) -> None:
    """The same files in another folder have the same hashes."""
    for part in ("core", "spec", "proofs"):
        shutil.copytree(ROOT / part, tmp_path / part, ignore=shutil.ignore_patterns("__pycache__"))
    other = Keys()
    other.tree.packages["cratous"] = tmp_path
    assert other.readings.digest == keys.readings.digest
    assert other.prover.digest == keys.prover.digest
