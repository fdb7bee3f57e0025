"""Forks writers of a log and kills them at random moments; prints what each left behind.

Run by test_log_crash.py: `python log_crash_child.py FOLDER ROUNDS SEED`. Each line of output is
JSON: what the writer said it had committed and accepted, and what a reader found.
"""

from __future__ import annotations

import json
import mmap
import os
import random
import shutil
import signal
import struct
import sys
import time
import traceback
from pathlib import Path

from cratous.services.logs.entry import Entry
from cratous.services.logs.sqlite_log import SqliteLog
from cratous.services.logs.store import LogStore

BATCH = 50


def body(number: int) -> bytes:
    return b"%d," % number * (20 + number % 50)


def write(path: Path, said: mmap.mmap, count: int) -> None:
    store = LogStore(path, batch=BATCH, every_s=0.01)
    for number in range(count):
        said[8:16] = struct.pack("q", number + 1)  # accepted, at most
        store.write(Entry(0, number, "writer", "test", body(number)))
        said[0:8] = struct.pack("q", store.committed)
        if number % 300 == 299:
            time.sleep(0.002)  # so that commits by time happen too
    said[16:24] = struct.pack("q", 1)
    store.close()


def found(path: Path) -> dict[str, object]:
    if not path.exists():
        return {"there": False}
    with SqliteLog(path) as log:
        log.verify()
        entries = list(log.entries())
        good = all(e.seq == e.time_ms == k and e.body == body(k) for k, e in enumerate(entries))
        return {"there": True, "read": len(entries), "good": good, "closed": bool(log.closing())}


def one(folder: Path, number: int, dice: random.Random) -> dict[str, object]:
    path = folder / f"log_{number}.sqlite"
    said = mmap.mmap(-1, 24)
    closes = number % 4 == 3  # these are killed while they close the log
    count = dice.randrange(2000) if closes else 10**9
    child = os.fork()
    if child == 0:
        try:
            write(path, said, count)
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            os._exit(1)
    if closes:
        while not said[16]:
            time.sleep(0)
        time.sleep(dice.uniform(0, 0.02))
    else:  # a third of them in the first moments, while the file is being made
        time.sleep(dice.uniform(0, 0.05) if number % 3 == 0 else dice.uniform(0.05, 0.3))
    os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    committed, accepted, closing = struct.unpack("qqq", said[0:24])
    copied = folder / f"copy_{number}.sqlite"
    if path.exists():  # database and WAL, without the shared-memory file
        shutil.copyfile(path, copied)
        wal = path.with_name(path.name + "-wal")
        if wal.exists():
            shutil.copyfile(wal, copied.with_name(copied.name + "-wal"))
        journal = path.with_name(path.name + "-journal")
        if journal.exists():
            shutil.copyfile(journal, copied.with_name(copied.name + "-journal"))
    result = found(path)
    result |= {"committed": committed, "accepted": accepted, "copy": found(copied)}
    if os.WIFEXITED(status) and os.WEXITSTATUS(status):
        raise SystemExit("a writer failed")
    return {**result, "closing": bool(closing), "killed": os.WIFSIGNALED(status)}


def main() -> None:
    folder, rounds, dice = Path(sys.argv[1]), int(sys.argv[2]), random.Random(sys.argv[3])
    for number in range(rounds):
        print(json.dumps(one(folder, number, dice)), flush=True)


main()
