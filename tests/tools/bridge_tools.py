"""What the tests of bridges share: configurations of bridges, a TCP server, what a bus delivers, damage."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hypothesis import strategies as st
from uxas_tools import free_port, process, write_cfg

ALL = "".join(f'<SubscribeToMessage MessageType="{c}"/>' for c in "aeul")
TCP = '<Bridge Type="LmcpObjectNetworkTcpBridge" Server="TRUE" TcpAddress="tcp://127.0.0.1:{}" {}>{}</Bridge>\n'
PAIR = '<Bridge Type="{}" Address{}="{}" Address{}="{}" {}>{}</Bridge>\n'


def tcp_server(folder: Path, attributes: str = "", inside: str = ALL, more: str = "") -> Any:
    port = free_port()
    one, said = process(write_cfg(folder, more + TCP.format(port, attributes, inside)))
    return one, said, port


def seen(one: Any, source: str = "") -> list[Any]:
    """What the bus delivers from now on, from one source or from all."""
    found: list[Any] = []
    one.bus.tap(lambda e: found.append(e) if not source or e.source == source else None)
    return found


@st.composite
def one_byte_changed(draw: st.DrawFn, sent: bytes) -> bytes:
    """What was sent, with another byte in one place."""
    place = draw(st.integers(0, len(sent) - 1))
    byte = draw(st.integers(0, 255).filter(lambda b: b != sent[place]))
    return sent[:place] + bytes([byte]) + sent[place + 1 :]
