"""The text protocol of the bridge: lines of heartbeats and plans to messages, on one core.

`python bench/text_lines.py` prints messages per second of CPU time for complete lines in reads of 64 KiB, and, for
comparison, for lines each split in two, which are read field by field. The target is 100,000.
"""

from __future__ import annotations

import time
from collections.abc import Iterable

from table import on_one_core

from cratous.bridge.text_protocol import Direction, StreamParser

LINES = b"""\
POSTN,timegps1.010000,lat37.099997,long-76.424616,altabs300.000000,altrel300.000000,north-0.002177,east22.000000,\
down0.000000,hdop0.100000,vdop0.100000,numsats25.0,id2.0,
ATTUD,roll0.022547,pitch0.000000,yaw0.000000,
OBJCT,type_TRAFFIC_,lat37.080282,long-76.400000,alt300.000000,north22.000000,east0.000000,down0.000000,index1.0,
WAYPT,total3.0,speed22.000000,lat37.100014,long-76.371755,alt300.000000,index2.0,
WPRCH,id0.0,
"""
TIMES, REPEAT, READ_BYTES = 4000, 5, 65536


def rate(pieces: Iterable[bytes]) -> float:
    """Messages per second of CPU time, the best of some runs."""
    given, best = list(pieces), 0.0
    for _ in range(REPEAT):
        parser, count, start = StreamParser(Direction.DOWN), 0, time.process_time()
        for piece in given:
            count += len(parser.feed(piece))
        best = max(best, count / (time.process_time() - start))
    return best


def main() -> None:
    """Print both figures."""
    on_one_core()
    data, lines = LINES * TIMES, LINES.splitlines(keepends=True) * TIMES
    whole = [data[k : k + READ_BYTES] for k in range(0, len(data), READ_BYTES)]
    cut = [piece for line in lines for piece in (line[:3], line[3:])]
    print(f"whole lines: {rate(whole):,.0f} messages a second; cut ones: {rate(cut):,.0f}")


if __name__ == "__main__":
    main()
