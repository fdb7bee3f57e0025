"""Sensors and tracker: what is drawn, what is of whom, when a track counts and when it ends."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.core.kernel import Vec2
from cratous.core.permit.association import in_gate
from cratous.services.sensing import tracks as module
from cratous.services.sensing.filter import Flown
from cratous.services.sensing.sensors import Detection, detections
from cratous.services.sensing.tracks import Tracks, estimate, tracked
from cratous.spec.mission import Position, Velocity
from cratous.spec.mission.sensing import Sensing, Sensor, SensorKind

ADSB = Sensor(SensorKind.ADSB, 10.0, 8.0, 1.0, latency_ms=400)
RADAR = Sensor(SensorKind.RADAR, 15.0, 15.0, 2.0, period_ms=500, range_m=3000.0)
BOTH = Sensing((ADSB, RADAR), seed=3)
OWN = 1
STEP_MS = 250


def flown(t_ms: int, **others: tuple[float, float, float, float]) -> dict[int, Flown]:
    """Own vehicle at the origin, others `n7=(north, east, velocity north, east)`, t_ms after they were there."""
    found = {OWN: Flown(Position(0.0, 0.0, 300.0), Velocity(20.0, 0.0, 0.0))}
    for name, (north, east, fast, across) in others.items():
        t = t_ms / 1000
        place = Position(north + fast * t, east + across * t, 300.0)
        found[int(name[1:])] = Flown(place, Velocity(fast, across, 0.0))
    return found


def run(
    sensing: Sensing, until_ms: int, seed: int = 0, **others: tuple[float, float, float, float]
) -> list[tuple[int, Tracks]]:
    """The tracks at each heartbeat."""
    found, under_way, tracks = [], list[Detection](), Tracks()
    for now in range(0, until_ms + 1, STEP_MS):
        under_way += detections(sensing, seed, OWN, now, STEP_MS, flown(now, **others))
        if now % 500 == 0:
            came = [one for one in under_way if one.due_ms <= now]
            under_way = [one for one in under_way if one.due_ms > now]
            tracks = tracked(tracks, came, sensing, now)
            found.append((now, tracks))
    return found


def test_errors_are_those_of_the_sensor_and_belong_to_it_alone() -> None:
    alone = flown(0, n7=(1000, 0, 0, 30))
    two = flown(0, n7=(1000, 0, 0, 30), n8=(500, 500, 0, 0))
    first = detections(BOTH, 5, OWN, 0, STEP_MS, alone)
    assert first == detections(BOTH, 5, OWN, 0, STEP_MS, alone)
    assert set(first) < set(detections(BOTH, 5, OWN, 0, STEP_MS, two))
    assert not set(first) & set(detections(BOTH, 6, OWN, 0, STEP_MS, alone))
    assert not set(first) & set(detections(replace(BOTH, seed=4), 5, OWN, 0, STEP_MS, alone))
    assert [(one.name, one.due_ms) for one in first] == [(7, 400), (0, 0)]
    many = [
        d for seed in range(2000) for d in detections(Sensing((ADSB,)), seed, OWN, 0, 250, alone)
    ]
    for component, size in ((0, 10.0), (1, 10.0), (2, 8.0)):
        off = [d.seen.position[component] - alone[7].position[component] for d in many]
        assert math.sqrt(sum(x * x for x in off) / len(off)) == pytest.approx(size, rel=0.06)
    off = [d.seen.velocity.east_m_s - 30 for d in many]
    assert math.sqrt(sum(x * x for x in off) / len(off)) == pytest.approx(1.0, rel=0.06)


def test_drop_outs_range_and_period() -> None:
    far = flown(0, n7=(3001, 0, 0, 0))
    assert [d.sensor for d in detections(BOTH, 0, OWN, 0, STEP_MS, far)] == [0]
    assert detections(BOTH, 0, OWN, 750, STEP_MS, far) == ()
    lossy = Sensing((replace(ADSB, drop_out=0.3),))
    came = sum(len(detections(lossy, seed, OWN, 0, STEP_MS, far)) for seed in range(2000))
    assert came == pytest.approx(1400, abs=70)
    # a period that is no multiple of a step: the first step in each
    odd = Sensing((replace(ADSB, period_ms=600),))
    at = [t for t in range(0, 3000, 250) if detections(odd, 0, OWN, t, STEP_MS, far)]
    assert at == [0, 750, 1250, 2000, 2500]


def test_a_track_counts_after_enough_updates_and_ends_after_the_last() -> None:
    sensing = Sensing((replace(ADSB, latency_ms=0),), confirm_hits=3, confirm_of=4, coast_ms=2000)
    seen = run(sensing, 3000, n7=(1000, 0, 0, 20))
    assert [(now, [t.shown for t in tracks.tracks]) for now, tracks in seen if now % 1000 == 0] == [
        (0, [False]), (1000, [False]), (2000, [True]), (3000, [True]),
    ]  # fmt: skip
    last = seen[-1][1]
    assert len(tracked(last, [], sensing, 4999).tracks) == 1
    assert tracked(last, [], sensing, 5000).tracks == ()
    # two updates of six are not three of four
    thin = Tracks()
    for now in (0, 3000, 6000):
        came = detections(sensing, 0, OWN, now, STEP_MS, flown(now, n7=(1000, 0, 0, 20)))
        thin = tracked(thin, came, replace(sensing, coast_ms=9000), now)
    assert [t.shown for t in thin.tracks] == [False]


def test_radar_and_ads_b_make_one_track_and_two_aircraft_stay_two() -> None:
    others = {"n7": (1000.0, -600.0, 0.0, 20.0), "n8": (1400.0, 600.0, 0.0, -20.0)}
    for seed in range(5):
        for now, tracks in run(BOTH, 40_000, seed, **others)[4:]:
            shown = [t for t in tracks.tracks if t.shown]
            assert [(t.number, t.source) for t in shown] == [(7, 7), (8, 8)]
            assert all(t.base.at_ms <= now for t in shown)
    radar = run(Sensing((RADAR,)), 40_000, **others)[-1][1]
    shown = [t for t in radar.tracks if t.shown]
    assert sorted((t.number, t.source) for t in shown) == [(-2, 8), (-1, 7)]


def test_a_radar_track_gets_the_id_that_comes_later() -> None:
    before = run(Sensing((RADAR,)), 2000, n7=(1000, 0, 0, 20))[-1][1]
    assert [t.number for t in before.tracks] == [-1]
    heard = detections(BOTH, 0, OWN, 2000, STEP_MS, flown(2000, n7=(1000, 0, 0, 20)))
    after = tracked(before, heard[:1], BOTH, 2400)
    assert [(t.number, t.shown) for t in after.tracks] == [(7, True)]


@given(st.integers(0, 50))
def test_it_does_not_matter_in_which_order_measurements_come(seed: int) -> None:
    sensing = replace(BOTH, sensors=(ADSB, replace(RADAR, latency_ms=2000)), sigmas=8.0)
    path = {"n7": (1000.0, 0.0, 3.0, 20.0)}
    first = detections(sensing, seed, OWN, 0, STEP_MS, flown(0, **path))[:1]
    rest = [
        d
        for now in (500, 1000, 1500)
        for d in detections(sensing, seed, OWN, now, STEP_MS, flown(now, **path))
    ]
    states = set()
    for order in list(permutations(rest))[::5]:
        tracks = tracked(Tracks(), first, sensing, 0)
        for one in order:
            tracks = tracked(tracks, [one], sensing, 1500)
        (track,) = tracks.tracks
        states.add(estimate(track, 2000, sensing.manoeuvre_m_s2))
    assert len(states) == 1


def test_who_flies_straight_is_within_its_bound_and_who_turns_begins_anew() -> None:
    off = 0
    for seed in range(40):
        for now, tracks in run(BOTH, 20_000, seed, n7=(1000, -900, 5, 30)):
            for track in (t for t in tracks.tracks if t.shown):
                known = estimate(track, now, BOTH.manoeuvre_m_s2)
                true = flown(now, n7=(1000, -900, 5, 30))[7].position
                apart = math.hypot(known.position[0] - true[0], known.position[1] - true[1])
                off += apart > 4 * math.sqrt(known.wide.place)
    assert off == 0
    sensing = Sensing((replace(ADSB, latency_ms=0),))
    steady = run(sensing, 10_000, n7=(1000, 0, 0, 30))[-1][1].tracks[0]
    turned = detections(sensing, 0, OWN, 11_000, STEP_MS, flown(11_000, n7=(1000, 330, 0, 0)))
    (anew,) = tracked(Tracks((steady,)), turned, sensing, 11_000).tracks
    known = estimate(anew, 11_000, sensing.manoeuvre_m_s2)
    assert (known.position, known.velocity) == turned[0].seen[1:3]


@given(
    st.tuples(*[st.integers(-60, 60)] * 3), st.tuples(*[st.integers(0, 12)] * 2), st.integers(0, 5)
)
def test_the_gate_is_so_many_deviations_wide(
    off: tuple[int, int, int], sigma: tuple[int, int], sigmas: int
) -> None:
    x, y, up = off
    wide, high = sigma
    within = math.isqrt(x * x + y * y - 1) + 1 if x or y else 0
    expected = within <= sigmas * wide and abs(up) <= sigmas * high
    assert in_gate(Vec2(x, y), up, wide * wide, high * high, sigmas) == expected


def test_a_scan_of_many_takes_each_track_once(monkeypatch: pytest.MonkeyPatch) -> None:
    sensing = replace(BOTH, sensors=(RADAR,))
    others = {f"n{k}": (400.0 * k, 0.0, 0.0, 0.0) for k in range(2, 7)}
    _, tracks = run(sensing, 1000, **others)[-1]
    scan = detections(sensing, 0, OWN, 1500, STEP_MS, flown(1500, **others))
    calls, real = list[int](), module.estimate
    monkeypatch.setattr(
        module, "estimate", lambda track, *more: calls.append(track.number) or real(track, *more)
    )
    tracked(tracks, scan, sensing, 1500)
    # once to find whose measurements these are, and once to hold each against its own
    assert len(calls) == len(scan) + len(tracks.tracks) == 10
