"""The ledger's gate: whatever could change a kernel's meaning is caught, with its name."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest
from ledger_tools import RESEAL, check, copied, prove, restored

from cratous.core import ledger
from cratous.core.ledger import key_parts, records


@pytest.fixture(scope="module")
def product(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return copied(root, tmp_path_factory.mktemp("product"))


def test_the_committed_ledger_vouches_for_the_committed_code():
    standing = ledger.check()
    assert [f"{p.name}: {p.what}" for p in standing.problems] == []
    assert standing.theorems >= 30
    assert standing.assumptions == 0


RECORDS = "core/ledger/records"
ATTACKS = {
    # what is edited: (file, old, new, what the gate says)
    "a kernel": (
        "core/well_clear/now.py", "return abs(sz) <= tcoa_s", "return abs(sz) < tcoa_s",
        "vertical_violation: changed since the proof: its source"),
    "a callee": (
        "core/well_clear/during.py", "return b < 0 and 0 - b", "return b <= 0 and 0 - b",
        "in_conflict: changed since the proof: its source"),
    "a record's order of fields": (
        "core/well_clear/during.py", "    first: float\n    last: float", "    last: float\n    first: float",
        "layer_window: changed since the proof: its source"),
    "a constant": ("core/authority/gate.py", "return Gate(1, gate.epoch + 1, False)",
                   "return Gate(1, gate.epoch + 0, False)", "gate_takeover: changed"),
    "a constant of a definition": (
        "spec/constraint_rows.py", "NOT_BEFORE, NOT_AFTER = 1, 2, 3, 4, 5, 6", "NOT_BEFORE, NOT_AFTER = 2, 1, 3, 4, 5, 6",
        "row_holds: changed since the proof: its definition in spec"),
    "an argument's range": (
        "core/authority/timeliness.py", ', nonnegative=("least",)', "",
        "lasted: changed since the proof: its source"),
    "a fold's start": ("core/schedule/rows.py", "start=True", "start=False",
                       "schedule_holds: changed since the proof: its source"),
    "a definition": ("spec/well_clear.py", "return dot(s, v) < 0", "return dot(s, v) <= 0",
                     "its definition in spec"),
    "a theorem weakened to true": (
        "proofs/theorems/well_clear/violation_is_symmetric.py", "c.show(c.same(ours, theirs))",
        "c.show(c.same(ours, ours))", "violation: changed since the proof: its theorems"),
    "a lemma weakened": (
        "proofs/methods/volumes.py", "c.premise(k > 0)",
        "c.premise(k == 1)", "violation_within: changed since the proof: its theorems"),
    "a theorem's sentence": (
        "proofs/theorems/well_clear/violation_is_symmetric.py", "Well clear is symmetric", "All is well",
        "its theorems"),
    "a theorem removed": ("proofs/theorems/well_clear/violation_is_symmetric.py", None, None,
                          "violation: changed since the proof: its theorems"),
    "the prover": ("proofs/engine/prover.py", '"unsat": "proved"', '"sat": "proved"', "the prover"),
    "numba's flags": ("core/readings/machine/compiled.py", "fastmath=False", "fastmath=True",
                      "the compiler flags"),
    "how kernels are compiled": ("core/readings/machine/compiled.py", "range(out.size)", "range(out.size - 1)",
                                 "the readings"),
    "a driver": ("core/geofence/mission_legs.py", "box[2] <= a.y <= box[3]", "box[2] < a.y <= box[3]", "leg_ok: changed"),
    "a driver's checker removed": (
        "core/avoidance/prediction.py",
        '@driver(checked_by=("violation_within", "uncertain_conflict"))',
        '@driver(checked_by=())', "first_violation_s: changed since the proof: its source"),
    "a kernel's mark removed": (
        "core/well_clear/now.py",
        '@kernel(implements="well_clear.violation", '
        'nonnegative=("dthr_m", "zthr_m", "tthr_s", "tcoa_s"))\n', "",
        "violation: it was proved but is no longer registered"),
    "how keys are made": ("core/ledger/definition_hash.py", "self.say(unit.digest)", "self.say(unit.name)",
                          "changed since the proof"),
    "a record": (f"{RECORDS}/kernels/well_clear.now.json", '"proved": true', '"proved": false',
                 "was edited"),
    "a record of a theorem": (f"{RECORDS}/theorems/schedule.json", '"status": "proved"', '"status": "Proved"',
                              "was edited"),
    "a record under another name": (f"{RECORDS}/kernels/well_clear.now.json", 'now.violation"', 'now.violated"',
                                    "was edited"),
    "a file of records cut short": (f"{RECORDS}/kernels/well_clear.now.json", '"kind"', '"ki', "cannot be read"),
    "a file of records removed": (f"{RECORDS}/kernels/well_clear.now.json", None, None,
                                  "violation: it is not in the ledger"),
    "a file of theorems removed": (f"{RECORDS}/theorems/schedule.json", None, None,
                                   "it rests on what is not in the ledger as proved"),
}  # fmt: skip


# none of these makes stale, or names, what another one of its row is to be caught by
TOGETHER = (
    ("a constant", "a constant of a definition", "an argument's range", "a fold's start", "a driver",
     "a theorem weakened to true"),
    ("a kernel", "a file of theorems removed"),
    ("a record's order of fields", "a file of records removed"),
    ("a lemma weakened", "a driver's checker removed"),
    ("the prover", "numba's flags"),
)  # fmt: skip
ALONE = sorted(set(ATTACKS) - {name for row in TOGETHER for name in row})
ALL_NAMED = "from cratous.core import ledger\nledger.LISTED = 10_000\n"


@pytest.mark.parametrize("names", [*TOGETHER, *((name,) for name in ALONE)], ids=", ".join)
def test_attacks_are_caught(names: tuple[str, ...], product: Path) -> None:
    files = {name: product / "cratous" / ATTACKS[name][0] for name in names}
    with restored(*files.values()):
        for name, file in files.items():
            place, old, new, _ = ATTACKS[name]
            if old is None:
                file.unlink()
                continue
            original = file.read_text()
            assert old in original, f"{old!r} is not in {place}: this attack needs an update"
            file.write_text(original.replace(old, new))
        done = check(product, ALL_NAMED)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "Refused" in done.stdout
    assert [name for name in names if ATTACKS[name][3] not in done.stdout] == []


# -- attacks that leave the source as it is ---------------------------------------------------
def test_planted_byte_code_is_caught(product: Path) -> None:
    """A .pyc with the source's date and size, but with another kernel in it."""
    file = product / "cratous" / "core" / "well_clear" / "now.py"
    text = file.read_text()
    wrong = text.replace("if ss <= dd:", "if ss >= dd:")
    assert len(wrong) == len(text)
    code = importlib._bootstrap_external._code_to_timestamp_pyc(
        compile(wrong, str(file), "exec"), int(file.stat().st_mtime), len(text.encode())
    )
    cached = Path(importlib.util.cache_from_source(str(file)))
    cached.parent.mkdir(exist_ok=True)
    cached.write_bytes(code)
    try:
        done = check(product)
    finally:
        cached.unlink()
    assert done.returncode == 1, done.stdout
    assert "horizontal_violation: the code that runs is not its file's" in done.stdout


def test_a_function_replaced_in_memory_is_caught(product: Path) -> None:
    code = "import cratous.core.well_clear as w\n"
    code += "exec(w.__file__ and 'def f(sz, vz, zthr_m, tcoa_s):\\n return False', vars(w))\n"
    code += "w.vertical_violation.__code__ = w.f.__code__\n"
    done = check(product, code)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "  vertical_violation: " in done.stdout
    assert "  violation: " in done.stdout  # it calls the replaced one


def test_a_function_that_runs_another_function_of_its_file_is_caught(product: Path) -> None:
    code = "import cratous.core.authority.timeliness as t\n"
    code += "t.in_time.__code__ = t.lasted.__code__\n"
    for renamed in ("", "t.in_time.__name__ = t.in_time.__qualname__ = 'lasted'\n"):
        done = check(product, code + renamed)
        assert done.returncode == 1, done.stdout + done.stderr
        assert "timeliness.in_time: " in done.stdout or "  in_time: " in done.stdout


PLANT = """
import sys
from pathlib import Path
from cratous.core.readings.machine import compiled
from cratous.core.geofence.planar import straddles
real = compiled.load
seen = []
compiled.load = lambda text: seen.append(text) or real(text)
right = compiled.compiled(straddles)([1.0, 0.0], [1.0, 1.0]).tolist()
folder = compiled.private_cache() / ("kernels_" + compiled.digest([seen[-1]])[:32])
print(folder, right)
"""


def test_machine_code_of_another_text_is_not_used(product: Path, tmp_path: Path) -> None:
    """Code compiled from another text, planted under the folder name of the right one."""
    environment = {**os.environ, "PYTHONPATH": str(product), "CRATOUS_CACHE": str(tmp_path)}

    def run() -> tuple[Path, str]:
        done = subprocess.run(
            [sys.executable, "-c", PLANT],
            cwd=product, env=environment, capture_output=True, text=True, timeout=900,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        folder, right = done.stdout.strip().split(" ", 1)
        return Path(folder), right

    folder, right = run()
    assert right == "[False, True]"
    (module,) = folder.glob("kernels_*.py")
    text = module.read_text()
    planted = text.replace("<=", "<")
    assert planted != text
    # the wrong text is compiled in place, so that its machine code lies where the right one would
    for old in [*folder.glob("*.nb?"), *folder.glob("__pycache__/*")]:
        old.unlink()
    module.write_text(planted)
    spec = importlib.util.spec_from_file_location(folder.name, module)
    assert spec is not None
    assert spec.loader is not None
    wrong = importlib.util.module_from_spec(spec)
    sys.modules[folder.name] = wrong
    try:
        spec.loader.exec_module(wrong)
        import numpy as np

        out = np.empty(2, dtype=np.bool_)
        wrong._map(out, np.array([1.0, 0.0]), np.array([1.0, 1.0]))
    finally:
        del sys.modules[folder.name]
    assert out.tolist() != [False, True]
    assert list(folder.rglob("*.nbc")), "no machine code was planted"
    again, right = run()
    assert again == folder
    assert right == "[False, True]"
    assert module.read_text() == text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("edit", "place", "old", "new", "wanted"),
    [
        # few theorems look into this one, so that little is proved anew; the readings of all are made
        pytest.param(
            "", "core/authority/timeliness.py", "at + margin < planned", "at + margin <= planned",
            "NOT PROVED", marks=pytest.mark.long,
        ),
        pytest.param(
            'data["theorems"]["well_clear_violation_is_symmetric"]["sentence"] = "All is well."',
            "", "", "", "differs from these proofs in", marks=pytest.mark.long,
        ),
        (
            'del data["theorems"]["well_clear_violation_is_symmetric"]\n'
            'data["kernels"]["cratous.core.well_clear.now.violation"]["theorems"].remove("well_clear_violation_is_symmetric")',
            "", "", "", "differs from these proofs in",
        ),
    ],
)  # fmt: skip
def test_a_ledger_that_was_sealed_again_is_caught_by_proving(
    edit: str, place: str, old: str, new: str, wanted: str, product: Path
) -> None:
    """The seal is no secret: only a new proof shows that such a ledger lies. CI makes one."""
    file = product / "cratous" / place
    with restored(*(product / "cratous" / RECORDS).rglob("*.json"), *([file] if place else [])):
        if place:
            original = file.read_text()
            assert old in original
            file.write_text(original.replace(old, new))
        assert check(product, RESEAL.format(edit=edit)).returncode == 0
        done = prove(product, "--check")
    assert done.returncode == 1, done.stdout + done.stderr
    assert wanted in done.stdout + done.stderr


@pytest.mark.long
def test_a_driver_that_no_longer_calls_its_checker_is_refused_by_the_prover(product: Path) -> None:
    file = product / "cratous" / "core" / "avoidance" / "prediction.py"
    original = file.read_text()
    changed = original.replace("violation_within(", "bool(")
    assert changed != original
    with restored(file):
        file.write_text(changed)
        done = prove(product)
    assert done.returncode == 2, done.stdout + done.stderr
    assert "nothing calls 'cratous.core.well_clear.during.violation_within'" in done.stderr


def test_comments_and_layout_change_nothing(product: Path) -> None:
    file = product / "cratous" / "core" / "well_clear" / "now.py"
    with restored(file):
        file.write_text(
            file.read_text().replace("    if ss <= dd:", "    # a remark\n    if  ss<=dd :")
        )
        done = check(product)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_kernel_without_a_proof_is_refused(product: Path) -> None:
    file = product / "cratous" / "core" / "unproved.py"
    file.write_text(
        '"""One more kernel."""\n\nfrom cratous.core.kernel import kernel\n\n\n'
        '@kernel(implements="schedule.later_of")\ndef unproved(a: int, b: int) -> int:\n'
        '    """A sum."""\n    return a + b\n'
    )
    try:
        done = check(product)
    finally:
        file.unlink()
    assert done.returncode == 1
    assert "unproved: it is not in the ledger" in done.stdout


def test_no_ledger_no_flight(tmp_path: Path) -> None:
    standing = ledger.check(tmp_path / "none")
    assert {problem.name for problem in standing.problems} == set(ledger.load_all())
    assert standing.kernels == sum(e.kind != "driver" for e in ledger.load_all().values())


@pytest.mark.parametrize("text", ["[]", '{"a": {}}', '{"a": []}', "{", '{"a": {"seal": 1}}'])
def test_a_broken_ledger_is_an_error_not_a_crash(text: str, tmp_path: Path) -> None:
    file = tmp_path / "kernels" / "some.json"
    file.parent.mkdir()
    file.write_text(text)
    with pytest.raises(ledger.Refused, match=r"cannot be read|was edited"):
        ledger.read(tmp_path)


def test_the_untouched_product_is_vouched_for_and_the_gate_is_quick(product: Path) -> None:
    """CPU seconds of the gate beyond the imports, with its tables made: 0.7 where this was written."""
    code = "import time\nfrom cratous.core import ledger\nledger.load_all()\nbegun = time.process_time()\n"
    code += "ledger.require()\nprint('took', time.process_time() - begun)\n"
    untouched = check(product)
    assert untouched.returncode == 0, untouched.stdout + untouched.stderr
    assert "NOT VOUCHED" not in untouched.stdout
    done = check(product, code)
    assert done.returncode == 0, done.stdout + done.stderr
    assert float(done.stdout.split("took ")[1].split()[0]) < 3


@pytest.mark.parametrize(("name", "refused"), [("z3-solver", ""), ("numba", "the compiler flags")])
def test_another_solver_is_no_reason_to_refuse_another_compiler_is(
    name: str, refused: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = key_parts.version
    monkeypatch.setattr(key_parts, "version", lambda n: "9.9" if n == name else real(n))
    problems = [p.what for p in ledger.check().problems]
    assert bool(problems) == bool(refused)
    assert all(f"changed since the proof: {refused}" in what for what in problems)


def test_records_that_differ_by_the_solver_alone_are_the_same_proofs() -> None:
    data = ledger.read()
    for kind in records.KINDS:
        for name, record in data[kind].items():
            if kind == "kernels":
                record["key"]["solver"] = "z3 9.9"
            data[kind][name] = records.sealed(name, record)
    said = records.texts(data)
    folder = ledger.PRODUCT.records
    kernels = [place for place in said if place.startswith("kernels/")]
    assert records.differing(said, folder) == kernels
    assert records.differing(said, folder, provenance=False) == []
    assert records.solvers(data) == ["z3 9.9"]
    said[kernels[0]] = said[kernels[0]].replace('"status": "', '"status": "assumed, ', 1)
    assert records.differing(said, folder, provenance=False) == kernels[:1]
