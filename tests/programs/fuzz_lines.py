"""Lines of the CRATOUS text protocol, changed at random, against the parsers of both ends in each dialect: none may
raise, each line must be a message, unknown there or refused, and how the bytes are cut must change nothing. `python tests/programs/fuzz_lines.py [--lines 10000000] [--seed 1]`

Changed are bytes, numbers, fields and whole lines: taken out, doubled, exchanged, put in. In v2 it is packets that are
changed, and what is left whole goes on to the parser. Ends with 1 at the first fault.
"""

from __future__ import annotations

import argparse
import random
import resource
import time
from collections import Counter
from typing import Any

from cratous.bridge.text_protocol import Direction, Message, StreamParser
from cratous.bridge.text_protocol.authenticated_lines import Seal
from cratous.bridge.text_protocol.dialects import Dialect
from cratous.bridge.text_protocol.parser import Skipped

GOOD = b"""\
POSTN,timegps1.010000,lat37.099997,long-76.424616,altabs300.000000,altrel300.000000,north-0.002177,east22.000000,\
down0.000000,hdop0.100000,vdop0.100000,numsats25.0,id2.0,
ATTUD,roll0.022547,pitch0.000000,yaw0.000000,
OBJCT,type_TRAFFIC_,lat37.080282,long-76.400000,alt300.000000,north22.000000,east0.000000,down0.000000,index1.0,
WAYPT,total3.0,speed22.000000,lat37.100014,long-76.371755,alt300.000000,index2.0,
GEOFN,type_KEEPIN_,totalvert4.0,vertIndex1.0,lat45.300000,long-121.000000,floor0.000000,roof300.000000,zone1.0,
COMND,typeRESET_SFT,lat37.099997,long-76.424748,alt300.000000,
COMND,typeGEOFN_SEND,zone1.0,
WPRCH,id0.0,
OTHER,id2.0,total7.0,lat45.300000,long-121.000000,alt700.000000,index0.0,
EPOCH,type_ICAROUS_,epoch5.0,
SETMOD,type_ACTIVE_,epoch1.0,
SETVEL,north1.908598,east21.917054,down-0.000000,
SETPOS,lat45.300000,long-121.000000,alt700.000000,
GOTOWP,id3.0,
WPREQ,typeASTAR,slat45.0,slong-121.0,salt300.0,elat45.1,elong-121.0,ealt300.0,track0.0,vh22.0,vv0.0,request1.0,
RPRSP,typeWP,lat45.000000,long-121.000000,alt300.000000,spd22.000000,request1.0,
AGAIN,type_WAYPT_,number0.0,total7.0,first2.0,last4.0,
HBEAT,sequence7.0,time3.5,
HELLO,id1.0,
""".splitlines(keepends=True)
NUMBERS = (
    b"",
    b"-",
    b"0",
    b"1e999",
    b"nan",
    b"inf",
    b"-1.0",
    b"9" * 40,
    b"1.0.0",
    b"0x10",
    b"999999999999999",
)
AT_ONCE = 500
"""Lines that go to a parser as one piece."""
WAYS = (*Dialect, None)
"""The dialects without keys, and v2."""
KEY = bytes(32)


class End:
    """What reads the bytes of one connection; dialect None: v2."""

    def __init__(self, direction: Direction, dialect: Dialect | None, original: bool) -> None:
        self._seal = Seal(1, KEY, KEY) if dialect is None else None
        self._parser = StreamParser(
            direction, original_peer=original, dialect=dialect or Dialect.CRATOUS
        )

    def read(self, *pieces: bytes) -> tuple[list[Any], list[Any]]:
        """The records of pieces that come one after the other, and the packets that were refused."""
        records, refused = list[Any](), list[Any]()
        for piece in pieces:
            if self._seal is not None:
                piece, wrong = self._seal.feed(piece)
                refused += wrong
            records += self._parser.feed(piece)
        return records + self._parser.finish(), refused


def unaccounted(data: bytes, sealed: bool, records: list[Any], refused: list[Any]) -> int:
    """How many lines are neither a message, nor unknown, nor refused. sealed: a packet cut off at the end is not read."""
    lines = data.count(b"\n") + (not sealed and data[-1:] != b"\n")
    # what is skipped behind column 1 is a field of a message
    once = sum(not (isinstance(one, Skipped) and one.column > 1) for one in records)
    return lines - once - len(refused)


def written(dialect: Dialect | None, seal: Seal, draw: random.Random) -> bytes:
    """A line as it stands on the wire."""
    line = draw.choice(GOOD)
    if dialect is None:
        return seal.wrap(line, 0)
    if dialect is Dialect.THESIS:  # five letters, and no comma after them
        tag, _, rest = line.partition(b",")
        return tag[:5] + rest
    return line


def changed(line: bytes, draw: random.Random) -> bytes:
    """A line with up to four changes."""
    for _ in range(draw.randrange(5)):
        at = draw.randrange(len(line) + 1)
        kind = draw.randrange(7)
        if kind == 0:
            line = line[:at] + bytes((draw.randrange(256),)) + line[at + 1 :]
        elif kind == 1:
            line = line[:at] + line[at + draw.randrange(1, 9) :]
        elif kind == 2:
            line = line[:at] + line[max(0, at - draw.randrange(1, 30)) :]
        elif kind == 3:
            fields = line.split(b",")
            draw.shuffle(fields)
            line = b",".join(fields)
        elif kind == 4:
            line = line[:at] + draw.choice(NUMBERS) + line[at:]
        elif kind == 5:
            line = line[:at] + draw.choice(GOOD)[: draw.randrange(60)] + line[at:]
        else:
            line = (
                line[:at]
                + draw.choice((b"\r\n", b"\n", b"\0", b",,", b"_", b"\xff\xfe"))
                + line[at:]
            )
    return line


def main() -> int:
    """Print how many were read and refused; 1 if a parser raised, left a line out, or reads otherwise when cut."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--lines", type=int, default=10_000_000)
    options.add_argument("--seed", type=int, default=1)
    asked = options.parse_args()
    draw, counts, begun = random.Random(asked.seed), Counter[str](), time.process_time()
    for number in range(0, asked.lines, AT_ONCE):
        dialect, seal = draw.choice(WAYS), Seal(1, KEY, KEY)
        data = b"".join(changed(written(dialect, seal, draw), draw) for _ in range(AT_ONCE))
        direction = draw.choice(list(Direction))
        original = bool(draw.randrange(2))
        whole, cut = (End(direction, dialect, original) for _ in range(2))
        at = draw.randrange(len(data))
        try:
            records, refused = whole.read(data)
            again = cut.read(data[:at], data[at:])
        except Exception as error:
            print(f"seed {asked.seed}, after {number:,} lines: {error!r} at {data!r}")
            return 1
        if (records, refused) != again:
            print(
                f"seed {asked.seed}, after {number:,} lines: another reading when cut at {at}: {data!r}"
            )
            return 1
        if lost := unaccounted(data, dialect is None, records, refused):
            print(
                f"seed {asked.seed}, after {number:,} lines: {lost} lines unaccounted for: {data!r}"
            )
            return 1
        counts.update("read" if isinstance(one, Message) else type(one).__name__ for one in records)
        counts["packets refused"] += len(refused)
    told = ", ".join(f"{count:,} {name}" for name, count in sorted(counts.items()))
    memory_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
    print(
        f"{asked.lines:,} lines changed at random: {told}; {memory_mb:.0f} MB, {time.process_time() - begun:.0f} s of CPU"
    )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
