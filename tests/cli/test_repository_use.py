"""The workflow and the hooks of docs/guides/reports.md, in a scratch repository, without a network."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from cratous.services.cli import main

pytestmark = pytest.mark.skipif(shutil.which("git") is None, reason="git is not on this machine")
FILE = re.compile(r"^`([\w/]+\.py)`\n```python\n(.*?)^```", re.S | re.M)
HOOK = """#!{python}
# what pre-commit does with a hook of `language: system`: its entry, with the staged files that it is for
import re, subprocess, sys
staged = subprocess.run(
    ["git", "diff", "--cached", "--name-only", "--diff-filter=ACM"], capture_output=True, text=True
).stdout.split()
codes = []
for entry, pattern in {hooks!r}:
    files = [name for name in staged if re.search(pattern, name)]
    if files:
        codes.append(subprocess.run([*entry.split(), *files]).returncode)
sys.exit(any(codes))
"""


class Repository:
    """A git repository of a user, with `cratous` on the path and no way out to a network."""

    def __init__(self, folder: Path, root: Path) -> None:
        self.folder = folder / "repository"
        self.folder.mkdir()
        program = folder / "bin" / "cratous"
        program.parent.mkdir()
        program.write_text(f'#!/bin/sh\nexec {sys.executable} -m cratous "$@"\n')
        program.chmod(0o755)
        path = os.pathsep.join(
            part for part in (str(root / "src"), os.environ.get("PYTHONPATH")) if part
        )
        self.env = {
            **os.environ, "PYTHONPATH": path, "PATH": f"{program.parent}{os.pathsep}{os.environ['PATH']}",
            "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1", "GIT_AUTHOR_NAME": "user",
            "GIT_AUTHOR_EMAIL": "u@localhost", "GIT_COMMITTER_NAME": "user",
            "GIT_COMMITTER_EMAIL": "u@localhost", "HTTPS_PROXY": "http://127.0.0.1:9",
        }  # fmt: skip
        assert self.shell("git init -q").returncode == 0

    def shell(self, command: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["bash", "-e", "-c", command], cwd=self.folder, env=self.env,
            capture_output=True, text=True, timeout=900, check=False,
        )  # fmt: skip

    def write(self, name: str, text: str) -> None:
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def commit(self) -> subprocess.CompletedProcess[str]:
        return self.shell("git add -A && git commit -q -m change")


@pytest.fixture
def repository(tmp_path: Path, root: Path) -> Repository:
    made = Repository(tmp_path, root)
    mission = (root / "examples" / "crossing" / "mission.yaml").read_text(encoding="utf-8")
    made.write("missions/survey/mission.yaml", mission.replace("name: crossing", "name: survey"))
    return made


def page(root: Path) -> str:
    return (root / "docs" / "guides" / "reports.md").read_text(encoding="utf-8")


def workflow(root: Path) -> list[dict[str, Any]]:
    (text,) = [
        t for t in re.findall(r"^```yaml\n(.*?)^```", page(root), re.S | re.M) if "jobs:" in t
    ]
    (job,) = yaml.safe_load(text)["jobs"].values()
    return list(job["steps"])


@pytest.mark.slow
def test_the_workflow_in_a_repository(repository: Repository, root: Path) -> None:
    """Each of its commands, in order, and what its other steps take is there afterwards."""
    text = (root / "docs" / "guides" / "own-kernel.md").read_text(encoding="utf-8")
    for name, body in FILE.findall(text):
        repository.write(name, body)
    assert repository.commit().returncode == 0
    steps = workflow(root)
    commands = [s["run"] for s in steps if "run" in s and not s["run"].startswith("pip install")]
    assert [c.split()[1] for c in commands] == ["check", "prove", "run", "certify"]
    for command in commands:
        done = repository.shell(command)
        assert done.returncode == 0, (command, done.stdout, done.stderr)
    taken = [s["with"] for s in steps if "upload" in s.get("uses", "")]
    (artifact, scan) = taken
    for name in (*artifact["path"].split("\n"), scan["sarif_file"]):
        assert (repository.folder / name).exists(), name
    assert (repository.folder / "views" / "junit.xml").exists()
    (run,) = json.loads((repository.folder / scan["sarif_file"]).read_text())["runs"]
    assert all(one["level"] == "note" for one in run["results"])
    places = [one["locations"][0]["physicalLocation"] for one in run["results"]]
    # the file of the repository, with the line
    assert {p["artifactLocation"]["uri"] for p in places} == {"missions/survey/mission.yaml"}
    assert all(p["region"]["startLine"] >= 1 for p in places)


LOW = """parameter vehicle: id
parameter floor: m
signal z: m from AirVehicleState[ID=$vehicle].Location.Altitude hold 1 s
requirement FLOOR: z >= $floor
"""


def test_hooks_refuse_what_cannot_be_read(repository: Repository, root: Path) -> None:
    hooks = yaml.safe_load((root / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
    assert [hook["id"] for hook in hooks] == re.findall(r"- id: (cratous-\w+)", page(root))
    assert all(hook["language"] == "system" for hook in hooks)
    hook = repository.folder / ".git" / "hooks" / "pre-commit"
    hook.write_text(
        HOOK.format(python=sys.executable, hooks=[(h["entry"], h["files"]) for h in hooks])
    )
    hook.chmod(0o755)
    repository.write("missions/order.algebra", ".(p1 p2)\n")
    repository.write("common/low.req", LOW)
    repository.write(
        "own.req", 'include "common/low.req" as one with vehicle is 1, floor is 90 m\n'
    )
    repository.write("notes.yaml", "no: mission\n")
    done = repository.commit()
    assert done.returncode == 0, done.stderr
    good = (repository.folder / "missions/survey/mission.yaml").read_text(encoding="utf-8")
    repository.write("missions/survey/mission.yaml", good.replace("id: 2", "id: 1", 1))
    done = repository.commit()
    assert done.returncode != 0
    assert "missions/survey/mission.yaml:" in done.stderr
    assert "an id is used twice" in done.stderr
    repository.write("missions/survey/mission.yaml", good)
    repository.write("missions/order.algebra", ".(p1 p2\n")
    done = repository.commit()
    assert done.returncode != 0
    assert "missions/order.algebra" in done.stderr
    repository.write("missions/order.algebra", ".(p1 p2)\n")
    repository.write("own.req", 'include "common/low.req" as one\n')
    done = repository.commit()
    assert done.returncode != 0
    assert "nothing gives this parameter a value" in done.stderr
    assert "common/low.req, line 1" in done.stderr
    assert repository.shell("git log --oneline").stdout.count("\n") == 1


def test_check_names_every_file_and_every_problem(
    root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    good = root / "examples" / "crossing" / "mission.yaml"
    bad = tmp_path / "mission.yaml"
    bad.write_text(good.read_text(encoding="utf-8").replace("id: 2", "id: 1"), encoding="utf-8")
    (tmp_path / "bytes.algebra").write_bytes(b"\xff")
    files = [good, bad, tmp_path / "gone.yaml", tmp_path / "bytes.algebra"]
    assert main(["check", *map(str, files)]) == 2
    printed = capsys.readouterr()
    assert printed.out == f"{good}: can be read\n"
    assert main(["check", "--json", *map(str, files)]) == 2
    data = json.loads(capsys.readouterr().out)
    assert [Path(one["file"]) for one in data["files"]] == files
    numbers = [len(one["problems"]) for one in data["files"]]
    assert (numbers[0], numbers[2], numbers[3]) == (0, 1, 1)
    assert numbers[1] > 1, "all that is wrong, not the first alone"
    assert printed.err.count("cratous: ") == sum(numbers)
    assert main(["check", str(good)]) == 0
    assert main(["check"]) == 2
