"""The envelope of a message on the bus of UxAS, as used in ZeroMQ and sentinel frames.

    address$contentType|descriptor|sourceGroup|sourceEntityId|sourceServiceId$payload

Subscriptions match the address: normally the full type name of the payload, also the address of a
service or group. Content type `lmcp` says that the payload is an LMCP message, the descriptor is its
full type name. Only the first two `$` are separators: the payload may contain any bytes. Ids are
kept as the text received, so that a message that is passed on leaves as it arrived.
Format: UxAS 3.2 (AddressedAttributedMessage).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from cratous.spec.errors import BadInput

LMCP = "lmcp"
ATTRIBUTES = ("contentType", "descriptor", "sourceGroup", "sourceEntityId", "sourceServiceId")
MAX_HEADER = 4096  # limit for address and attributes together, including their `$` [bytes]
_MIN = 11  # [bytes], as in UxAS


@dataclass(frozen=True, slots=True)
class AddressedMessage:
    """One message with its address and attributes.

    address: what it is published under. content_type: `lmcp` for LMCP. descriptor: full type name.
    group: source group, may be empty. entity_id, service_id: of the sender, decimal text.
    payload: the bytes of the message.
    """

    address: str
    content_type: str
    descriptor: str
    group: str
    entity_id: str
    service_id: str
    payload: bytes

    @property
    def attributes(self) -> tuple[str, str, str, str, str]:
        """The five attributes in the order of the wire (`ATTRIBUTES`)."""
        return self.content_type, self.descriptor, self.group, self.entity_id, self.service_id

    def sent_by(self, group: str, entity_id: int | str, service_id: int | str) -> AddressedMessage:
        """The same message with other source attributes, as a bridge that imports it sets them."""
        return replace(self, group=group, entity_id=str(entity_id), service_id=str(service_id))

    def pack(self) -> bytes:
        """The bytes for the wire; BadInput for a part that `parse` would read differently."""
        for name, text in zip(
            ("address", *ATTRIBUTES), (self.address, *self.attributes), strict=True
        ):
            if "$" in text or ("|" in text and name != "address"):
                raise BadInput("separator in a part of an envelope", item=name, got=repr(text))
        try:
            head = f"{self.address}${'|'.join(self.attributes)}$".encode()
        except UnicodeEncodeError as err:
            raise BadInput("envelope without UTF-8 form", got=str(err.reason)) from None
        if not self.address or not self.payload:
            raise BadInput(
                "empty part of an envelope", item="payload" if self.address else "address"
            )
        if len(head) > MAX_HEADER:
            raise BadInput(
                "envelope too long", expected=f"at most {MAX_HEADER} bytes", got=f"{len(head)}"
            )
        return head + self.payload


def parse(data: bytes | memoryview, where: str = "envelope") -> AddressedMessage:
    """The message of the bytes of one ZeroMQ part or one sentinel frame's payload.

    Raises BadInput with the byte for: no two `$`, other than five attributes, an empty address or
    payload, parts that are not UTF-8 or longer than MAX_HEADER.

    >>> parse(b"a.B$lmcp|a.B||100|66$LMCP").service_id
    '66'
    """
    raw = bytes(data)
    if len(raw) < _MIN:
        raise BadInput(
            "too short", where=where, expected=f"at least {_MIN} bytes", got=f"{len(raw)}"
        )
    first = raw.find(b"$", 0, MAX_HEADER)
    second = raw.find(b"$", first + 1, MAX_HEADER) if first >= 0 else -1
    if second < 0:
        raise BadInput(
            "no end of the attributes" if first >= 0 else "no end of the address",
            where=f"{where}: byte {first + 1}",
            expected=f"'$' within {MAX_HEADER} bytes",
            got="none",
        )
    try:
        address = raw[:first].decode("utf-8")
        parts = raw[first + 1 : second].decode("utf-8").split("|")
    except UnicodeDecodeError as err:
        raise BadInput(
            "not UTF-8", where=where, item="address or attributes", got=err.reason
        ) from None
    if not address:
        raise BadInput("empty address", where=f"{where}: byte 0", expected="a type name")
    if len(parts) != len(ATTRIBUTES):
        raise BadInput(
            "wrong number of attributes",
            where=f"{where}: byte {first + 1}",
            expected="|".join(ATTRIBUTES),
            got=f"{len(parts)}",
        )
    if second + 1 == len(raw):
        raise BadInput("no payload", where=f"{where}: byte {second + 1}", expected="a message")
    content, descriptor, group, entity_id, service_id = parts
    return AddressedMessage(
        address, content, descriptor, group, entity_id, service_id, raw[second + 1 :]
    )


def enclose(
    full_name: str,
    payload: bytes,
    *,
    group: str = "",
    entity_id: int = 0,
    service_id: int = 0,
    address: str = "",
) -> AddressedMessage:
    """The envelope of an LMCP message: addressed to its type, or to `address` (unicast, group)."""
    return AddressedMessage(
        address or full_name, LMCP, full_name, group, str(entity_id), str(service_id), payload
    )
