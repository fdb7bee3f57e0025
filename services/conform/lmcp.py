"""Suite `lmcp`: messages of other implementations, in both directions, in binary, XML and JSON.

A *message* gives `type`, `fields` (our JSON form) and `hex`; `xml`, `xml_cpp`, `xml_py` are the
same object as written by others, `tcp_java` the same message in a sentinel frame. It passes if the
bytes are read to exactly these fields and written to exactly these bytes (also through the lazy
reader), every XML text is read to the same object, and our own XML and JSON are read back to it;
for kind `default`, a new object of the type must be equal.

A *quirk* gives `case`, `hex` and `outcome`, what each implementation did with it. Where Python,
Java and C++ all accepted the message, it must be read and written to the same bytes (except the
checksum). Where they disagree, a typed error with its position passes as well; a message that is
read with a changed meaning never passes.
"""

from __future__ import annotations

from typing import Any

from cratous.bridge import envelope, lmcp, sentinel
from cratous.services.conform import Result, failed, not_covered, passed
from cratous.spec.errors import BadInput

FORMS = ("xml", "xml_cpp", "xml_py")


def judge(case: dict[str, Any]) -> Result:
    """Run one case of the suite; the results of its checks."""
    if "hex" not in case:
        return not_covered(str(case.get("case", case.get("type", "?"))), "no bytes given")
    try:
        raw = bytes.fromhex(case["hex"])
    except (TypeError, ValueError):
        raise BadInput("not hexadecimal", item="hex", got=repr(case["hex"])[:40]) from None
    if "case" in case:
        return _quirk(str(case["case"]), raw, case.get("outcome"))
    if not isinstance(case.get("fields"), dict):
        return not_covered(str(case.get("type", "?")), "no fields given")
    return _message(f"{case.get('type')} {case.get('kind', '')}".strip(), raw, case)


def _message(name: str, raw: bytes, case: dict[str, Any]) -> Result:
    checks = 0
    try:
        obj = lmcp.binary.unpack(raw)
        wanted = lmcp.from_dict(case["fields"])
        for what, good in (
            ("bytes to fields", obj == wanted and lmcp.to_json(obj) == lmcp.to_json(wanted)),
            ("fields to bytes", lmcp.binary.pack(wanted) == raw),
            ("bytes, lazily", lmcp.to_json(lmcp.binary.lazy(raw)) == lmcp.to_json(obj)),
            ("XML of our own", lmcp.xml.loads(lmcp.xml.dumps(obj), finite=False) == [wanted]),
            ("JSON of our own", lmcp.binary.pack(lmcp.from_json(lmcp.to_json(obj))) == raw),
        ):
            checks += 1
            if not good:
                return failed(name, what, f"{what}: {obj!r:.300}, expected {wanted!r:.300}", checks)
        if case.get("kind") == "default":
            checks += 1
            if lmcp.new(str(case.get("type"))) != wanted:
                return failed(name, "defaults", f"{lmcp.new(str(case.get('type')))!r:.300}", checks)
        for form in FORMS:
            if form in case:
                checks += 1
                read = lmcp.xml.loads(case[form], f"{form}", [], finite=False)
                if read != [wanted]:
                    return failed(
                        name, form, f"read {read!r:.300}, expected {wanted!r:.300}", checks
                    )
                if lmcp.binary.pack(read[0]) != raw:
                    return failed(name, f"{form} to bytes", f"{read!r:.300}", checks)
        if "tcp_java" in case:
            checks += 1
            framed = bytes.fromhex(case["tcp_java"])
            message = envelope.parse(sentinel.unframe(framed))
            if message.payload != raw or sentinel.frame(message.pack()) != framed:
                return failed(name, "tcp_java", f"got {message}", checks)
    except BadInput as error:
        return failed(name, "refused", str(error), checks + 1)
    return passed(name, checks)


def _quirk(name: str, raw: bytes, outcome: Any) -> Result:
    kept = isinstance(outcome, dict) and all(
        str(outcome.get(side, "")).startswith("same") for side in ("py", "java", "cpp")
    )
    try:
        obj = lmcp.binary.unpack(raw)
    except BadInput as error:
        if kept:
            return failed(name, "refused what all keep", str(error))
        if not error.where:
            return failed(name, "error without a place", str(error))
        return passed(name)
    again = lmcp.binary.pack(obj)
    if again[:-4] != raw[:-4]:
        return failed(name, "changed silently", f"written as {again.hex()[:200]}")
    try:
        read = lmcp.xml.loads(lmcp.xml.dumps(obj), "XML", [], finite=False)
    except BadInput as error:
        if not error.item:
            return failed(name, "error without a place", str(error), 2)
        return passed(name, 2)
    if lmcp.binary.pack(read[0]) != again:
        return failed(name, "changed by XML", f"{read[0]!r:.300}, expected {obj!r:.300}", 2)
    return passed(name, 2)
