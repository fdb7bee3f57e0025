"""`cratous prove --scheduler`: a real scheduler and worker, an honest one, one that lies, one of another version."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from cluster_tools import cluster
from guide_package import written

from cratous.proofs.elsewhere import Beside, kept
from cratous.proofs.engine.cache import Answer, Cache
from cratous.services.cli import main
from cratous.spec.errors import BadInput

pytest.importorskip("distributed")
CLAIM = '''"""What is false."""

from my_pkg.reserve import reaches_home


def claim(c):
    fuel, reserve, distance, speed, burn = c.reals("fuel reserve distance speed burn")
    c.premise(speed > 0)
    home = c.use(reaches_home, fuel, reserve, distance, speed, burn)
    c.show(c.implies(home, {shown}))
'''
FALSE = {
    "twice": "fuel * speed >= 2 * (reserve * speed + distance * burn)",
    "never": "fuel * fuel != 2",  # no number that a theorem is run on is that root
}
LIES = """
import sys
from pathlib import Path
sys.path.insert(0, ".")
from cratous.core import ledger
from cratous.proofs.engine import prover
from cratous.proofs.engine.cache import Answer, Cache
home = ledger.package("my_pkg")
ledger.load_all()
ledger.load_all(home)
lies = Cache(Path(sys.argv[1]))
for name in sys.argv[2:]:
    theorem = prover.prove_file(name, folder=home.theorems)
    assert not theorem.proved
    for outcome in theorem.outcomes:
        lies.put(outcome.key, prover.RLIMIT, Answer("unsat", 1, 0.5, "ALL"))
"""


class Place:
    """A folder with the package of the guide, and the cache of a machine."""

    def __init__(self, root: Path, folder: Path) -> None:
        self.folder, self.root = folder, root
        folder.mkdir(exist_ok=True)
        written(root, folder)

    def environment(self, machine: str) -> dict[str, str]:
        cache = self.folder / machine
        cache.mkdir(exist_ok=True, mode=0o700)
        return {**os.environ, "PYTHONPATH": str(self.root / "src"), "CRATOUS_CACHE": str(cache)}

    def run(self, *words: str, machine: str = "here") -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, *words], cwd=self.folder, env=self.environment(machine), text=True,
            capture_output=True, timeout=600,
        )  # fmt: skip

    def prove(self, *options: str, machine: str = "here") -> subprocess.CompletedProcess[str]:
        command = ("-m", "cratous", "prove", "--package", "my_pkg", *options)
        return self.run(*command, machine=machine)

    def records(self) -> dict[str, bytes]:
        folder = self.folder / "my_pkg" / "ledger"
        return {str(f.relative_to(folder)): f.read_bytes() for f in folder.rglob("*.json")}


@pytest.fixture
def place(root: Path, tmp_path: Path) -> Place:
    return Place(root, tmp_path / "place")


@pytest.fixture
def address(place: Place) -> Iterator[str]:
    """A scheduler with a worker where the package is, which has a cache of its own."""
    with cluster(1, place.folder, place.environment("worker")) as (found, _):
        yield found


@pytest.mark.slow
def test_what_vouches_is_asked_here_whatever_workers_say(place: Place, address: str) -> None:
    part = ("--only", "reserve_is_kept", "--json")
    told = place.prove(*part, "--scheduler", address)
    assert told.returncode == 3, told.stdout + told.stderr
    said = json.loads(told.stdout)
    assert (said["said_elsewhere"], said["theorems"]) == (["reserve_is_kept"], [])
    assert "workers say that 1 of 1 are proved" in told.stderr
    assert place.records() == {}
    alone = place.prove(*part)
    assert alone.returncode == 0, alone.stderr
    found = json.loads(alone.stdout)
    assert (found["said_elsewhere"], found["proved"]) == ([], 1)
    assert found["z3_cpu_seconds"] > 0, "asked here, though workers have answered"
    whole = place.prove("--scheduler", address, machine="third")
    assert whole.returncode == 0, whole.stderr
    records = place.records()
    assert place.prove(machine="fourth").returncode == 0
    assert records == place.records() != {}


@pytest.mark.slow
def test_a_lying_worker_changes_no_verdict(place: Place, address: str) -> None:
    for name, shown in FALSE.items():
        file = place.folder / "my_pkg" / "theorems" / f"{name}.py"
        file.write_text(CLAIM.format(shown=shown))
    lies = place.folder / "worker" / "cratous" / "proofs"
    lied = place.run("-c", LIES, str(lies), *FALSE, machine="liar")
    assert lied.returncode == 0, lied.stderr
    told = place.prove("--only", "twice", "--only", "never", "--scheduler", address, "--json")
    assert told.returncode == 1, told.stdout + told.stderr
    assert "workers say that 2 of 2 are proved" in told.stderr
    said = json.loads(told.stdout)
    assert (said["proved"], said["said_elsewhere"]) == (0, ["never"])
    assert [theorem["name"] for theorem in said["theorems"]] == ["twice"]
    whole = place.prove("--scheduler", address)
    assert whole.returncode == 1, whole.stdout + whole.stderr
    assert {f"NOT PROVED {name}" for name in FALSE} <= {
        line.partition(" (")[0] for line in whole.stdout.splitlines()
    }
    assert place.records() == {} or all(
        b'"proved": true' not in r for r in place.records().values()
    )


@pytest.mark.slow
def test_a_worker_of_another_version_is_refused(root: Path, place: Place) -> None:
    other = Place(root, place.folder.parent / "other")
    file = other.folder / "my_pkg" / "spec" / "fuel.py"
    file.write_text(file.read_text() + "\n# another version\n")
    with cluster(1, other.folder, other.environment("worker")) as (address, _):
        done = place.prove("--only", "reserve_is_kept", "--scheduler", address)
    assert done.returncode == 2, done.stdout + done.stderr
    assert "another version" in done.stderr


def test_answers_of_others_are_taken_after_ones_own_and_never_kept_as_such(tmp_path: Path) -> None:
    own, others = tmp_path / "own", tmp_path / "others"
    keys = [character * 64 for character in "abc"]
    rows = [[key, 5, result, 1, 0.5, "ALL", ""] for key, result in zip(keys, ("unsat", "unknown", "sat"), strict=True)]  # fmt: skip
    assert kept({"proved": True, "answers": rows}, others, "a worker")
    Cache(own).put(keys[2], 5, Answer("unsat", 1, 0.5, "ALL"))
    cache = Beside(own, others)
    found = [cache.get(key, 5) for key in keys]
    assert [answer and answer.result for answer in found] == ["unsat", None, "unsat"]
    assert cache.taken == 1
    assert [Cache(own).get(key, 5) is None for key in keys] == [True, True, False]


@pytest.mark.parametrize(
    "result",
    [
        {}, {"answers": []}, {"proved": True, "answers": [1]}, {"proved": True, "answers": [["a"]]},
        {"proved": True, "answers": [["../../x", 5, "unsat", 1, 0.5, "ALL", ""]]}, None,
        {"proved": True, "answers": [["a" * 64, "5", "unsat", 1, 0.5, "ALL", ""]]},
    ],
)  # fmt: skip
def test_what_is_no_answer_is_bad_input(tmp_path: Path, result: object) -> None:
    with pytest.raises(BadInput, match="no answers to what was asked"):
        kept(result, tmp_path, "a worker")


@pytest.mark.parametrize(
    "options",
    [["--recheck"], ["--mutate"], ["--self-test"], ["--only", "daa_*", "--junit", "j.xml"]],
)
def test_what_needs_each_theorem_here_goes_with_no_scheduler(
    capsys: pytest.CaptureFixture[str], options: list[str]
) -> None:
    assert main(["prove", "--scheduler", "tcp://127.0.0.1:1", *options]) == 2
    assert "--scheduler does not go with" in capsys.readouterr().err
