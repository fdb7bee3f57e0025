"""The cache folder is this user's alone, or it is refused."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from cratous.core.files import private_cache as private
from cratous.core.files.private_cache import private_cache
from cratous.core.geofence.planar import straddles
from cratous.core.readings.machine.compiled import compiled
from cratous.services.cli import main
from cratous.spec.errors import BadInput

pytestmark = pytest.mark.skipif(not hasattr(os, "getuid"), reason="no owners in mode bits here")


@pytest.fixture
def base(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("CRATOUS_CACHE", str(tmp_path / "base"))
    private._private.cache_clear()
    return tmp_path / "base"


def mode(folder: Path) -> int:
    return stat.S_IMODE(folder.stat().st_mode)


def test_it_is_made_for_its_user_alone(base):
    base.mkdir()
    old = os.umask(0)
    try:
        assert private_cache() == base / "cratous"
    finally:
        os.umask(old)
    assert mode(base / "cratous") == 0o700


def test_one_that_others_could_only_read_is_closed(base):
    (base / "cratous").mkdir(parents=True)
    (base / "cratous").chmod(0o755)
    assert mode(private_cache()) == 0o700


@pytest.mark.parametrize("open_to", [0o770, 0o707, 0o777, 0o722])
def test_one_that_others_may_write_to_is_refused(base, open_to):
    (base / "cratous").mkdir(parents=True)
    (base / "cratous").chmod(open_to)
    with pytest.raises(BadInput, match=f"others may write to it .mode {open_to:o}") as caught:
        private_cache()
    assert caught.value.where == str(base / "cratous")
    assert mode(base / "cratous") == open_to, "nothing is repaired"


def test_another_user_s_is_refused(base, monkeypatch):
    (base / "cratous").mkdir(parents=True, mode=0o700)
    monkeypatch.setattr(os, "getuid", lambda: 4242)
    with pytest.raises(BadInput, match="belongs to the user with number"):
        private_cache()


def test_one_that_anybody_may_exchange_is_refused(base):
    base.mkdir()
    base.chmod(0o777)
    with pytest.raises(BadInput, match="anybody may exchange it"):
        private_cache()
    base.chmod(0o1777)
    assert private_cache() == base / "cratous"


def test_a_link_or_a_file_in_its_place_is_refused(base, tmp_path):
    base.mkdir()
    (tmp_path / "elsewhere").mkdir()
    (base / "cratous").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(BadInput, match="it is no folder"):
        private_cache()
    (base / "cratous").unlink()
    (base / "cratous").write_text("")
    with pytest.raises(BadInput, match="cannot be made"):
        private_cache()


def test_no_machine_code_is_taken_from_such_a_folder_and_no_proof(base, capsys):
    (base / "cratous").mkdir(parents=True)
    (base / "cratous").chmod(0o777)
    compiled.cache_clear()
    from cratous.core.readings.machine import compiled as module

    module._straight_map.cache_clear()
    with pytest.raises(BadInput, match="cannot be trusted"):
        compiled(straddles)([1.0], [1.0])
    assert main(["prove", "--only", "schedule_later_and_*"]) == 2
    assert "cannot be trusted" in capsys.readouterr().err
