"""The files of the argument: their form, the command that writes them, and the signature over them."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml
from certify_tools import Run, read, unconfirmed

from cratous.services.argument.form import faults, schema_text

GOOD = {
    "G-a": {"text": "t", "supportedBy": ["S-a"], "inContextOf": ["C-a"]},
    "S-a": {"text": "t", "supportedBy": ["G-b", "G-c"]},
    "G-b": {"text": "t", "supportedBy": ["Sn-a"]},
    "G-c": {"text": "t", "undeveloped": True, "classes": ["violated"]},
    "Sn-a": {"text": "t"},
    "C-a": {"text": "t"},
}


@pytest.mark.parametrize(
    ("name", "entry", "said"),
    [
        ("G-c", {"text": "t"}, "is not valid under any"),
        ("G-c", {"text": "t", "supportedBy": []}, "non-empty"),
        ("G-c", {"text": "t", "supportedBy": ["Sn-a"], "undeveloped": True}, "valid under each of"),
        ("G-c", {"text": "", "undeveloped": True}, "non-empty"),
        ("G-c", {"text": "t", "undeveloped": True, "status": "x"}, "unexpected"),
        ("G-c", {"text": "t", "undeveloped": True, "classes": ["fine"]}, "is not one of"),
        ("G-c", {"text": "t", "supportedBy": ["Sn-a", "Sn-a"]}, "non-unique"),
        ("G-c", {"text": "t", "supportedBy": ["C-a"]}, "does not match"),
        ("G-c", {"text": "t", "undeveloped": True, "inContextOf": ["Sn-a"]}, "does not match"),
        ("Sn-a", {"text": "t", "supportedBy": ["G-b"]}, "False schema"),
        ("S-a", {"text": "t", "supportedBy": ["S-b"]}, "does not match"),
        ("X-a", {"text": "t"}, "does not match"),
        ("G-c", {"text": "t", "supportedBy": ["Sn-b"]}, "there is no element Sn-b"),
        ("G-c", {"text": "t", "supportedBy": ["G-c"]}, "G-c: it leads back to itself"),
        ("G-b", {"text": "t", "supportedBy": ["S-a"]}, "S-a: it leads back to itself"),
        ("G-d", {"text": "t", "undeveloped": True}, "expected one top goal, got G-a, G-d"),
        ("C-b", {"text": "t"}, "expected one top goal, got G-a, C-b"),
    ],
)  # fmt: skip
def test_what_is_not_well_formed_is_said(name: str, entry: Any, said: str) -> None:
    from jsonschema import Draft202012Validator

    Draft202012Validator.check_schema(json.loads(schema_text()))
    assert faults(GOOD) == []
    assert any(said in line for line in faults({**GOOD, name: entry})), faults(
        {**GOOD, name: entry}
    )


def test_the_command_writes_the_same_bytes_again(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    code, _, err = run("certify", flown, "--argument", "-o", tmp_path / "a")
    assert (code, err) == (read(flown)["exit_code"], "")
    assert sorted(f.name for f in (tmp_path / "a").iterdir()) == ["argument.svg", "argument.yaml"]
    assert run("certify", flown, "-o", tmp_path / "b")[0] == code
    for name in ("argument.svg", "argument.yaml"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    assert faults(yaml.safe_load((tmp_path / "a" / "argument.yaml").read_text("utf-8"))) == []


def test_there_is_none_of_what_is_not_confirmed(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    folder = unconfirmed(flown, tmp_path)
    assert run("certify", folder, "--argument", "-o", tmp_path / "v")[0] == 1
    assert not (tmp_path / "v").exists()


def test_the_argument_is_signed_with_the_views(
    run: Run, flown: Path, judged: None, tmp_path: Path
) -> None:
    crypto = pytest.importorskip("cryptography.hazmat.primitives.asymmetric.ed25519")
    from cryptography.hazmat.primitives import serialization as form

    key = crypto.Ed25519PrivateKey.generate()
    (tmp_path / "key.pem").write_bytes(
        key.private_bytes(form.Encoding.PEM, form.PrivateFormat.PKCS8, form.NoEncryption())
    )
    (tmp_path / "key.pub").write_bytes(
        key.public_key().public_bytes(form.Encoding.PEM, form.PublicFormat.SubjectPublicKeyInfo)
    )
    signed = tmp_path / "v"
    words = ("--argument", "--sign", "--key", tmp_path / "key.pem", "-o", signed)
    assert run("certify", flown, *words)[0] in (0, 3)
    verify = ("certify", "--verify", flown, "-o", signed, "--public-key", tmp_path / "key.pub")
    assert run(*verify)[0] in (0, 3)
    shutil.copy(signed / "argument.svg", signed / "argument.yaml")
    code, _, err = run(*verify)
    assert code == 1
    assert "refused: views/argument.yaml" in err
