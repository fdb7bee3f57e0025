"""The configurations that OpenUxAS ships are taken as they are; what is mended in them is said."""

from __future__ import annotations

from pathlib import Path

import pytest
from uxas_tools import process, write_cfg

from cratous.bridge import lmcp
from cratous.services.cli import main
from cratous.services.loading.uxas_settings import read
from cratous.services.uxas import manager
from cratous.spec.errors import BadInput

SHIPPED = Path(__file__).resolve().parents[3] / "shared" / "examples" / "openuxas-shipped"
CONFIGURATIONS = [
    path
    for path in sorted(SHIPPED.rglob("*cfg*.xml"))
    if path.name != "SendMessagesService_cfg.xml"  # a part of one
]
LACKING = {
    "cfg_MultiVehicleWatchTask.xml": "a comment has -- inside",
    "08_ExampleSparkService/cfg_ada.xml": "no service ExampleSparkService here",
}


@pytest.mark.skipif(not SHIPPED.is_dir(), reason="no ../shared/examples")
def test_every_configuration_is_accepted_and_says_what_it_lacks() -> None:
    assert len(CONFIGURATIONS) == 37
    for path in CONFIGURATIONS:
        notes: list[str] = []
        assert manager.check(read(path), notes=notes), path
        said = [text for name, text in LACKING.items() if str(path).endswith(name)]
        assert len(notes) == len(said), (path, notes)
        assert all(text in note for text, note in zip(said, notes, strict=True))


@pytest.mark.skipif(not SHIPPED.is_dir(), reason="no ../shared/examples")
def test_every_configuration_starts_and_sends_what_is_due(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All services are made, and all message files read and decoded; bridges are left out."""
    monkeypatch.chdir(tmp_path)
    for path in CONFIGURATIONS:
        config = read(path)
        bridges = frozenset(entry.type for entry in config.entries if entry.kind == "Bridge")
        one, said = process(path, virtual=True, without=bridges, data=tmp_path / "datawork")
        try:
            made = set(one.manager.services.values())
            for entry in config.entries:
                lacking = any(f"no service {entry.type} here" in line for line in said)
                assert entry.kind == "Bridge" or entry.type in made or lacking, (path, entry.type)
            one.run(0.5)
            assert not said.has("ERROR"), (path, said)
        finally:
            one.close()


@pytest.mark.skipif(not SHIPPED.is_dir(), reason="no ../shared/examples")
def test_every_message_file_of_a_configuration_is_read() -> None:
    for path in CONFIGURATIONS:
        for entry in read(path).entries:
            for child in entry.children:
                name = child.get("MessageFileName")
                found = name and path.parent / "MessagesToSend" / name
                if found and found.is_file():
                    assert lmcp.xml.read_messages(found, [])


def test_check_prints_what_is_lacking_and_strict_refuses_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_cfg(tmp_path, '<!-- two -- dashes -->\n<Service Type="HelloWorld"/>')
    assert main(["uxas", "-cfgPath", str(path), "--check"]) == 0
    assert f"warning: {path}:2: a comment has -- inside" in capsys.readouterr().out
    assert main(["uxas", "-cfgPath", str(path), "--check", "--strict"]) == 2
    assert "a comment has -- inside" in capsys.readouterr().err


TASK = "<LineSearchTask><TaskID>3</TaskID>\n<!-- a -- b -->\n<Label>x</Label></LineSearchTask>"


@pytest.mark.parametrize(
    ("text", "note"),
    [
        (TASK, "f.xml:2: a comment has -- inside, which XML forbids; skipped"),
        (TASK.replace(" -- ", " "), ""),
        (
            TASK.replace(" -- ", " ").replace("</LineSearchTask>", ""),
            "</LineSearchTask>, is missing",
        ),
        (TASK.replace("a -- b ", "</LineSearchTask> -"), "f.xml:2: a comment has -- inside"),
    ],
)
def test_text_that_is_nearly_xml_is_read_with_a_note(tmp_path: Path, text: str, note: str) -> None:
    path = tmp_path / "f.xml"
    path.write_text(text)
    notes: list[str] = []
    (task,) = lmcp.xml.read_messages(path, notes)
    assert (task.TaskID, task.Label) == (3, "x")
    assert note in "".join(notes)
    assert len(notes) == (1 if note else 0)


@pytest.mark.parametrize(
    "text",
    [
        "<LineSearchTask><TaskID>3</TaskID><Label>x",  # two end tags
        "<LineSearchTask><TaskID>3</TaskID></LineSearchTas",
        "<LineSearchTask><TaskID>3</Label></LineSearchTask>",
        "<LineSearchTask><!-- never ended <TaskID>3</TaskID></LineSearchTask>",
        "<LineSearchTask><TaskID>3</TaskID><![CDATA[</LineSearchTask>",
    ],
)
def test_nothing_else_is_mended(tmp_path: Path, text: str) -> None:
    path = tmp_path / "f.xml"
    path.write_text(text)
    with pytest.raises(BadInput, match="not well-formed XML"):
        lmcp.xml.read_messages(path, [])


def test_text_of_many_comments_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "f.xml"
    path.write_text("<a>" + "<!-- -- -->\n" * 100_000 + "<b>")
    with pytest.raises(BadInput):
        lmcp.xml.read_messages(path, [])
