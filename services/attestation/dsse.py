"""DSSE envelopes (Dead Simple Signing Envelope, version 1) with one Ed25519 signature.

The pre-authentication encoding of payload and payload type is signed, so that nothing of an
envelope is interpreted before its signature is verified. Ed25519 is deterministic: same key and
payload, same bytes. Keys are PEM (PKCS #8 and SubjectPublicKeyInfo, as openssl writes them); errors
and output never contain anything of a private key.
"""

from __future__ import annotations

import base64
import binascii
import hashlib
import json
import os
from pathlib import Path
from typing import Any

from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import text_of

PAYLOAD_TYPE = "application/vnd.in-toto+json"
KEY_VARIABLE = "CRATOUS_SIGNING_KEY"
KEY_BYTES = 10_000
"""Maximum size of a key file [bytes]; a PEM key has less than a tenth."""
ENVELOPE_BYTES = 10_000_000
PRIVATE = "an Ed25519 private key in PEM, without a password"
PUBLIC = "an Ed25519 public key in PEM"


def pre_authentication_encoding(payload: bytes, payload_type: str = PAYLOAD_TYPE) -> bytes:
    """The bytes that a DSSE signature covers: payload and its type, as DSSE defines them."""
    kind = payload_type.encode()
    return b"DSSEv1 %d %b %d %b" % (len(kind), kind, len(payload), payload)


def private_key(file: Path | None) -> Any:
    """The key in a file, or otherwise in the environment variable CRATOUS_SIGNING_KEY (PEM)."""
    from cryptography.exceptions import UnsupportedAlgorithm
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
    from cryptography.hazmat.primitives.serialization import load_pem_private_key

    where = str(file) if file else KEY_VARIABLE
    text = text_of(file, KEY_BYTES, "a key") if file else os.environ.get(KEY_VARIABLE, "")
    if not text.strip():
        raise BadInput(
            "there is no key to sign with", where=where, expected=f"{PRIVATE} (--key, or the "
            f"environment variable {KEY_VARIABLE})", got="nothing",
        )  # fmt: skip
    try:
        key = load_pem_private_key(text.encode(), None)
    except (ValueError, TypeError, UnsupportedAlgorithm):
        # the library's message may quote the key
        raise BadInput("not a key", where=where, expected=PRIVATE, got="something else") from None
    if not isinstance(key, Ed25519PrivateKey):
        raise BadInput("a key of another kind", where=where, expected=PRIVATE)
    return key


def public_key(file: Path) -> Any:
    """The public key of a file; BadInput if there is none, or a private one."""
    from cryptography.exceptions import UnsupportedAlgorithm
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey
    from cryptography.hazmat.primitives.serialization import load_pem_public_key

    try:
        key = load_pem_public_key(text_of(file, KEY_BYTES, "a key").encode())
    except (ValueError, UnsupportedAlgorithm):
        raise BadInput(
            "not a key", where=str(file), expected=PUBLIC, got="something else"
        ) from None
    if not isinstance(key, Ed25519PublicKey):
        raise BadInput("a key of another kind", where=str(file), expected=PUBLIC)
    return key


def key_id(public: Any) -> str:
    """SHA-256 of the 32 bytes of a public key, in hexadecimal: a hint only, not used for decisions."""
    return hashlib.sha256(public.public_bytes_raw()).hexdigest()


def signed(payload: bytes, key: Any) -> str:
    """The JSON text of an envelope with the signed payload."""
    signature = key.sign(pre_authentication_encoding(payload))
    envelope = {
        "payloadType": PAYLOAD_TYPE,
        "payload": base64.b64encode(payload).decode(),
        "signatures": [
            {"keyid": key_id(key.public_key()), "sig": base64.b64encode(signature).decode()}
        ],
    }
    return json.dumps(envelope, indent=1) + "\n"


def opened(text: str, public: Any) -> tuple[bytes, str]:
    """(payload, fault): the payload of an envelope signed by this key; otherwise empty, with the reason."""
    from cryptography.exceptions import InvalidSignature

    try:
        envelope = json.loads(text)
        payload = base64.b64decode(envelope["payload"], validate=True)
        kind = envelope["payloadType"]
        signatures = [base64.b64decode(one["sig"], validate=True) for one in envelope["signatures"]]
    except (ValueError, KeyError, TypeError, RecursionError, binascii.Error):
        return b"", "not a DSSE envelope"
    if kind != PAYLOAD_TYPE:
        return b"", f"its payload type is not {PAYLOAD_TYPE}"
    if not signatures:
        return b"", "it has no signature"
    for signature in signatures:
        try:
            public.verify(signature, pre_authentication_encoding(payload, kind))
        except InvalidSignature:
            continue
        return payload, ""
    return b"", "no signature of it is one by this key"
