"""The contracts that CrossHair looks at hold on plain random values too."""

from __future__ import annotations

import importlib.util
import inspect
import math
import random
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

FILE = Path(__file__).parents[1] / "programs" / "crosshair_targets.py"
_spec = importlib.util.spec_from_file_location("crosshair_targets", FILE)
assert _spec is not None
assert _spec.loader is not None
targets = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(targets)
CONTRACTS = [
    f for _, f in inspect.getmembers(targets, inspect.isfunction) if f.__module__ == _spec.name
]
ALPHABET = "0123456789 ()._-~|+p[]\n\té"


def _value(kind: str, rng: random.Random) -> Any:
    if kind == "int":
        return rng.choice((0, 1, 2, 3, 4, 5, 6, rng.randint(-20, 5000), rng.getrandbits(70)))
    if kind == "float":
        return rng.choice((0.0, -1e-17, 2 * math.pi, -1e300, rng.uniform(-10, 10)))
    text = "".join(rng.choices(ALPHABET, k=rng.randrange(16)))
    digits = "".join(rng.choices("0123456789", k=rng.randrange(1, 12)))
    if kind == "str":
        return rng.choice((text, digits))
    return rng.choice((text.encode(), rng.randbytes(rng.randrange(20))))


def _first_asserts(contract: Callable[..., Any]) -> int:
    """Lines of the asserts that stand first: an AssertionError there is no finding."""
    lines, start = inspect.getsourcelines(contract)
    body = start + next(k for k, line in enumerate(lines) if '"""' in line) + 1
    while lines[body - start].lstrip().startswith("assert"):
        body += 1
    return body


@pytest.mark.parametrize("contract", CONTRACTS, ids=lambda f: f.__name__)
def test_contract_holds_on_random_values(contract: Callable[..., Any]) -> None:
    rng = random.Random(contract.__name__)
    kinds = [p.annotation for p in inspect.signature(contract).parameters.values()]
    last = _first_asserts(contract)
    looked_at = 0
    for _ in range(20_000):
        values = [_value(kind, rng) for kind in kinds]
        try:
            contract(*values)
        except AssertionError as error:
            trace = error.__traceback__
            while trace is not None and trace.tb_frame.f_code is not contract.__code__:
                trace = trace.tb_next
            assert trace is not None
            assert trace.tb_lineno < last, values
        else:
            looked_at += 1
            if looked_at >= 300:
                break
    assert looked_at >= 20, "hardly any value satisfies what may be assumed"


FALSE = """
import math
from cratous.services.mission.frames import compass


def a_compass_heading_is_below_180(heading_rad: float) -> None:
    assert math.isfinite(heading_rad)
    degrees = compass(heading_rad)
    assert degrees < 180
"""


def test_a_false_contract_fails_the_gate(root: Path, tmp_path: Path) -> None:
    """With the very options of `make crosshair`, and in the time that `.ci/run` gives it."""
    line = next(
        one for one in (root / "Makefile").read_text().splitlines() if "-m crosshair" in one
    )
    (tmp_path / "wrong.py").write_text(FALSE)
    options = line.split("-m crosshair ")[1].replace("$(EACH_S)", "2").split()[:-1]
    command = [sys.executable, "-m", "crosshair", *options, str(tmp_path / "wrong.py")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 1, done.stderr
    assert "a_compass_heading_is_below_180" in done.stdout
    assert "crosshair EACH_S=2" in (root / ".ci" / "run").read_text()
