"""Keys of packages that share one reading of the product are the keys that each would have alone."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from cratous.core import ledger as gate
from cratous.core.ledger.keys import Keys
from cratous.core.ledger.package_home import Home
from cratous.proofs.engine import worker_processes
from cratous.proofs.self_test import case, product_keys

LOOSE = "from cratous.core.ledger import key_parts\n\nkey_parts.PARTS.update(source='another')\n"


@pytest.mark.parametrize(("more", "shared"), [("", True), (LOOSE, False)])
def test_keys_are_the_same(more: str, shared: bool, tmp_path: Path) -> None:
    one = next(c for c in case.cases() if c.id == "modules/fine_kernel_of_another_module")
    one.write(tmp_path, "keyed")
    if more:
        (tmp_path / "keyed" / "changes.py").write_text(more)

    def both() -> tuple[list[Any], list[Any], bool]:
        sys.path.insert(0, str(tmp_path))
        home = Home("keyed", tmp_path / "keyed")
        gate.package("keyed")
        entries = gate.load_all(home)
        assert entries
        quick, alone = product_keys.PackageKeys(home), Keys(home)
        names = sorted(quick._files[home])
        said = [[keys.of(e, names) for e in entries.values()] for keys in (quick, alone)]
        same = quick.readings is product_keys._product().readings
        return said[0], said[1], same

    quick, alone, same = worker_processes.call(both)
    assert quick == alone
    assert same is shared


def test_a_package_that_the_product_names_is_read_with_it(tmp_path: Path) -> None:
    assert "numpy" in product_keys._named()
    assert "keyed" not in product_keys._named()
    (tmp_path / "numpy").mkdir()
    (tmp_path / "numpy" / "__init__.py").write_text("array = 1\n")
    keys = product_keys.PackageKeys(Home("numpy", tmp_path / "numpy"))
    assert keys.readings is not product_keys._product().readings
