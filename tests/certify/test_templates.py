"""What the templates of pages compile to is kept from run to run, and never shown for another text."""

from pathlib import Path

import pytest

from cratous.core.files.private_cache import private_cache
from cratous.services.certify.html import margin, seconds
from cratous.services.certify.templates import KEPT, environment


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("CRATOUS_CACHE", str(tmp_path))
    return private_cache()


def page(text: str, value: str = "<b>") -> str:
    shown: str = environment(lambda _: text).get_template("page").render(value=value)
    return shown


def test_a_template_is_compiled_once(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert page("a {{ value }}") == "a &lt;b&gt;"
    (kept,) = (cache / KEPT).glob("*/*")
    assert kept.parent.stat().st_mode & 0o077 == 0
    monkeypatch.setattr("jinja2.Environment.compile", None)
    assert page("a {{ value }}", "c") == "a c"


def test_another_text_is_compiled_anew(cache: Path) -> None:
    assert page("a {{ value }}") == "a &lt;b&gt;"
    assert page("b {{ value }}") == "b &lt;b&gt;"


def test_what_cannot_be_read_or_kept_is_compiled(cache: Path) -> None:
    assert page("a {{ value }}", "c") == "a c"
    (kept,) = (cache / KEPT).glob("*/*")
    kept.write_bytes(kept.read_bytes()[:-9])  # cut off
    assert page("a {{ value }}", "d") == "a d"
    kept.unlink()
    kept.parent.rmdir()
    (cache / KEPT).rmdir()
    (cache / KEPT).write_text("no folder", encoding="utf-8")
    assert page("a {{ value }}", "e") == "a e"


def test_a_folder_that_is_gone_when_a_template_is_to_be_kept_is_no_error(cache: Path) -> None:
    made = environment(lambda _: "a {{ value }}")
    (folder,) = (cache / KEPT).iterdir()
    folder.rmdir()
    assert made.get_template("page").render(value="c") == "a c"


def test_words_for_times_and_margins() -> None:
    assert (seconds(0), seconds(61_240), seconds(None)) == ("0.0 s", "61.2 s", "–")
    assert margin({"margin": None, "unit": ""}) == "–"
    assert margin({"margin": 12.3456, "unit": "m"}) == "12.35 m"
