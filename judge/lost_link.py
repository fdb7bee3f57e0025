"""G5 with a lost-link procedure: whether each vehicle began it in time, and flew nothing else.

Judged by what each ICAROUS reports (`LinkLossState`), the connections that the UxAS end reports
and, for a landing, the vehicle's position: unknown for a vehicle that may land and was not logged
throughout. Modes follow one another as in `AFTER`. If lines of the bridge were lost, damaged or
late, or ICAROUS stopped reading, the log does not show whether UxAS was heard.
"""

from __future__ import annotations

from collections.abc import Iterator

from cratous.judge.ground import MOVES, Down, down
from cratous.judge.log import Alone, Log
from cratous.judge.mission import LOITER, Mission, WithoutLink
from cratous.judge.tracks import Track
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, seconds

LINKED, OVER, LAND, FINAL, LANDED = "Linked", "Over", "Land", "Final", "Landed"
NOTICED = 2
"""Maximum delay of a report after the bound, in heartbeats."""


def rows(mission: Mission, log: Log, flown: dict[int, Track]) -> Iterator[Row]:
    """One row for each vehicle with an instance."""
    asked = mission.without_link
    if asked is None:
        return
    for vehicle in sorted(mission.instances):
        subject, item = ("alone", str(vehicle)), f"what vehicle {vehicle} flies without the link"
        said, place = log.alone.get(vehicle, []), down(mission, vehicle, flown.get(vehicle))
        failed_ms = _failed_ms(mission, log, vehicle)
        if failed_ms is not None:
            said = said[: log.declared[vehicle][0].said]
        faults = [*_faults(mission, asked, said), *_missed(mission, asked, log, vehicle, said)]
        if failed_ms is not None:
            pass  # how it ends is judged in the row on the failure
        elif log.end_ms is not None:
            faults += landing_faults(mission, flown, vehicle, said, log.end_ms)
        else:
            faults += _taken(mission, flown, vehicle, place)
        note = ", ".join(f"{one.mode} from {seconds(one.time_ms)}" for one in said)
        note = note or "it was never said to be without the link"
        note += "" if failed_ms is None else f", a failure declared at {seconds(failed_ms)}"
        note += f"; it {place.words()}" if place else ""
        if faults:
            at, text = min(faults)
            yield Row("G5", subject, item, VIOLATED, f"{text}; {note}", at, len(said))
        elif log.end_ms is None:
            note = f"the log stops before the mission ends; {note}"
            yield Row("G5", subject, item, UNKNOWN, note, None, len(said))
        elif mission.sites and (doubt := unseen(flown.get(vehicle))):
            yield Row("G5", subject, item, UNKNOWN, f"{note}; {doubt}", None, len(said))
        elif asked.lines_fail:
            note += "; whether UxAS was heard over a bridge that was made to fail is not in the log"
            yield Row("G5", subject, item, UNKNOWN, note, None, len(said))
        else:
            yield Row("G5", subject, item, HOLDS, note, None, len(said))


def _failed_ms(mission: Mission, log: Log, vehicle: int) -> int | None:
    """When a vehicle declared a failure [ms], from which on it flies something else; None if it did not."""
    said = log.declared.get(vehicle, []) if mission.after_failure is not None else []
    return said[0].time_ms if said else None


def unseen(track: Track | None) -> str:
    """Why the position of a vehicle is not known throughout; empty if it is."""
    return "no position of it was logged" if track is None else track.doubt


def follows(mode: str, chosen: str) -> set[str]:
    """The modes that may follow a mode."""
    if mode in (FINAL, LANDED):
        return {LANDED} - {mode}
    if mode == LINKED:
        return {chosen, LOITER}
    ends = {LAND: {FINAL}, LOITER: set[str]()}.get(chosen, {OVER})
    found = {
        LOITER: {LINKED, chosen},
        OVER: {LINKED},
        chosen: {LINKED, LOITER, *ends},
    }.get(mode, set())
    return found - {mode}


def _faults(mission: Mission, asked: WithoutLink, said: list[Alone]) -> Iterator[tuple[int, str]]:
    """Reports that are impossible."""
    mode, beat_ms = LINKED, mission.heartbeat_ms
    for one in said:
        silent_ms = one.time_ms - one.heard_ms
        if one.chosen != asked.choice:
            yield (
                one.time_ms,
                f"{one.chosen} is said to be chosen, the mission wants {asked.choice}",
            )
        if one.mode not in follows(mode, asked.choice):
            yield one.time_ms, f"{one.mode} does not follow {mode}"
        heard = 0 <= silent_ms <= asked.after_ms
        if one.mode != LANDED and heard != (one.mode == LINKED):
            yield one.time_ms, f"{one.mode} after a silence of {silent_ms} ms"
        if mode == LINKED and silent_ms > asked.after_ms + beat_ms:
            yield one.time_ms, f"it began {silent_ms} ms after UxAS was last heard"
        mode = one.mode


def _missed(
    mission: Mission, asked: WithoutLink, log: Log, vehicle: int, said: list[Alone]
) -> Iterator[tuple[int, str]]:
    """Connections that had been down for too long without a report."""
    since: int | None = None
    changes = [(s.time_ms, s.alive, s.lost) for s in log.bridges.get(vehicle, [])]
    failed_ms = _failed_ms(mission, log, vehicle)
    end_ms = log.end_ms if failed_ms is None else failed_ms
    changes = [one for one in changes if end_ms is None or one[0] <= end_ms]
    changes += [] if end_ms is None else [(end_ms, True, False)]
    for at_ms, alive, lost in changes:
        if not alive:
            since = at_ms if since is None and lost else since
            continue
        before = [one for one in said if one.time_ms < at_ms]
        mode, told_ms = (before[-1].mode, before[-1].time_ms) if before else (LINKED, 0)
        bound_ms = asked.after_ms + NOTICED * mission.heartbeat_ms
        if since is not None and mode == LINKED and at_ms - max(since, told_ms) > bound_ms:
            yield at_ms, f"its connection had ended at {seconds(since)}, and it said nothing"
        since = None


def _taken(
    mission: Mission, flown: dict[int, Track], vehicle: int, place: Down | None
) -> Iterator[tuple[int, str]]:
    """Whether another vehicle was on the ground of its site before it."""
    if place is None or place.site is None:
        return
    for other in mission.vehicles:
        there = down(mission, other, flown.get(other)) if other != vehicle else None
        if there and there.site == place.site and (there.at_ms, other) < (place.at_ms, vehicle):
            yield place.at_ms, f"it {place.words()}, where vehicle {other} was before it"


def landing_faults(
    mission: Mission, flown: dict[int, Track], vehicle: int, said: list[Alone], end_ms: int
) -> Iterator[tuple[int, str]]:
    """Faults of a vehicle's landing, and of its reports on it, by its position."""
    track = flown.get(vehicle)
    place = down(mission, vehicle, track)
    yield from _landing(mission, said, place, end_ms, track)
    yield from _taken(mission, flown, vehicle, place)


def _landing(
    mission: Mission, said: list[Alone], place: Down | None, end_ms: int, track: Track | None
) -> Iterator[tuple[int, str]]:
    """Faults of reports on landing, compared with the vehicle's position; none where it was not logged."""
    landed, seen = [one.time_ms for one in said if one.mode == LANDED], not unseen(track)
    # where it was logged before touchdown, it was in the air
    times = [] if track is None else track.times
    flew = [t for t in times if landed and landed[0] <= t and (place is None or t < place.at_ms)]
    if place is None:
        if flew:
            yield landed[0], "it said that it had landed, and was in the air"
    elif not (place.good or (place.fault == MOVES and not seen)):
        yield place.at_ms, f"it {place.words()}"
    elif flew:
        yield landed[0], f"it said that it had landed before it {place.words()}"
    elif not landed and end_ms - place.at_ms > NOTICED * mission.heartbeat_ms:
        yield end_ms, f"it {place.words()}, and did not say so"
