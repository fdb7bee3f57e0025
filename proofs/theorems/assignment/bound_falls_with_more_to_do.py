"""A latest departure does not become later when what follows has to be left for earlier, the way is
longer, the task is released later or is due earlier: who is late for some tasks is late for more."""

from cratous.core.assignment.steps import latest_departure
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    duration = c.integer("duration")
    due, after, release, travel = (c.integer(x) for x in ["due", "after", "release", "travel"])
    due2, after2, release2, travel2 = (
        c.integer(x) for x in ["due2", "after2", "release2", "travel2"]
    )
    for time in (release, release2, duration, travel, travel2):
        c.premise(c.all_of(time >= 0, time <= 2**58))
    for time in (due, after, due2, after2):
        c.premise(c.all_of(time >= -(2**58), time <= 2**58))
    for less, more in ((due2, due), (after2, after), (release, release2), (travel, travel2)):
        c.premise(less <= more)
    easy = c.use(latest_departure, due, after, release, duration, travel)
    hard = c.use(latest_departure, due2, after2, release2, duration, travel2)
    c.show(hard <= easy)
