"""The report: worst verdicts, text that cannot break out, and a page that stands alone."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.services.certify.charts import FEW, altitude_view, separation_view
from cratous.services.certify.html import render
from cratous.services.certify.picture import LETTER, map_view, time_view
from cratous.services.certify.report import ends_of
from cratous.services.certify.timeline import bars, read_flight
from cratous.services.certify.verdicts import constraint_rows, requirement_rows
from cratous.services.loading import load
from cratous.services.logs.log import Row
from cratous.spec.mission.guarantees import REQUIREMENTS, Kind, Outcome, Verdict


def row(requirement: str, outcome: Outcome, margin_value: float | None = None) -> dict[str, Any]:
    verdict = Verdict(requirement, "x", outcome, Kind.EXACT, "n", margin=margin_value, unit="m")
    return constraint_rows([verdict], "plan")[0]


def test_a_requirement_without_evidence_is_unknown() -> None:
    rows = requirement_rows([row("G1", Outcome.HOLDS, 5.0)])
    assert [r["verdict"] for r in rows] == ["holds"] + ["unknown"] * 4


@given(st.lists(st.sampled_from(list(Outcome)), min_size=1, max_size=6))
def test_the_worst_counts(outcomes: list[Outcome]) -> None:
    (found, *_) = requirement_rows([row("G1", outcome, 1.0) for outcome in outcomes])
    for worse in (Outcome.VIOLATED, Outcome.UNKNOWN, Outcome.EXCUSED, Outcome.HOLDS):
        if worse in outcomes:
            assert found["verdict"] == worse
            break


def test_the_least_margin_is_shown() -> None:
    rows = [row("G2", Outcome.HOLDS, value) for value in (7.0, 3.0, 9.0)]
    assert requirement_rows(rows)[1]["margin"] == 3.0


def test_whole_verdicts_are_made_again() -> None:
    whole = Verdict("G1", "", Outcome.HOLDS, Kind.EXACT, "n")
    assert constraint_rows([whole], "flight") == []


def message(seq: int, name: str, **body: Any) -> Row:
    return Row(seq, body["Time"], "test", f"cratous.{name}", json.dumps(body))


def truth(seq: int, vehicle: int, time: int, north: float, east: float) -> Row:
    return message(seq, "TruthState", VehicleID=vehicle, Time=time, North=north, East=east,
                   Altitude=300.0)  # fmt: skip


def authority(seq: int, time: int, owner: str, epoch: int) -> Row:
    return message(seq, "AuthorityChange", VehicleID=1, Time=time, Owner=owner, Epoch=epoch,
                   Reason="<b>near</b>", IntruderID=2)  # fmt: skip


def phase(seq: int, time: int, name: str) -> Row:
    return message(seq, "TaskProgress", VehicleID=1, TaskID=5, Time=time, Phase=name, Served=1.0,
                   Note="")  # fmt: skip


LOG = [
    message(0, "PlanAccepted", Time=0, Makespan=9000, PlanHash="ab"),
    phase(1, 0, "Transit"),
    *[truth(2 + k, 1, 250 * k, 5.0 * k, 0.0) for k in range(9)],
    *[truth(20 + k, 2, 250 * k, 0.0, 100.0 + k) for k in range(9)],
    authority(40, 2250, "ICAROUS", 1),
    phase(41, 2500, "Active"),
    truth(42, 1, 2750, 60.0, 0.0),
    truth(43, 2, 2750, 0.0, 110.0),
    authority(44, 3000, "UxAS", 3),
    phase(45, 4000, "Complete"),
    message(46, "MissionEnd", Time=4000, Outcome="complete"),
]


def test_the_flight_is_read_from_the_log() -> None:
    flight = read_flight(LOG, [1])
    assert (flight.outcome, flight.end_ms, flight.plan_hash) == ("complete", 4000, "ab")
    (takeover,) = flight.takeovers
    assert (takeover["from_ms"], takeover["to_ms"], takeover["intruder"]) == (2250, 3000, 2)
    assert flight.served[5]["time_ms"] == 4000
    assert [point[0] for point in flight.tracks[1]] == [0, 1000, 2000, 2750]
    assert [point[4] for point in flight.tracks[1]] == [0, 0, 0, 1]
    assert {point[0] for point in flight.tracks[2]} >= {0, 1000, 2000}
    shown = [(bar["what"], bar["from_ms"], bar["to_ms"]) for bar in bars(flight)]
    assert shown == [("transit", 0, 2500), ("icarous", 2250, 3000), ("task", 2500, 4000)]


def test_an_open_takeover_stays_open() -> None:
    flight = read_flight([r for r in LOG if r.seq != 44], [1])
    assert flight.takeovers[0]["to_ms"] is None


def test_a_log_without_an_end_says_so() -> None:
    assert "no end" in read_flight(LOG[:5], [1]).outcome


def test_a_task_that_was_withdrawn_has_not_failed() -> None:
    flight = read_flight([*LOG[:-1], phase(50, 5000, "Failed"), LOG[-1]], [1])
    assert flight.served[5]["phase"] == "Failed"
    mission = load(Path(__file__).resolve().parents[2] / "examples/popup/mission.yaml")
    kept = replace(mission, tasks=(replace(mission.tasks[0], id=5),))
    assert [end["phase"] for end in ends_of(flight, kept)] == ["Failed"]
    assert ends_of(flight, replace(mission, tasks=mission.tasks[:1])) == []


def report() -> dict[str, Any]:
    """A report with all its parts, small, with a name that would like to be markup."""
    flight = read_flight(LOG, [1])
    place = {"north_m": 0.0, "east_m": 0.0, "alt_m": 300.0}
    far = {"north_m": 400.0, "east_m": 200.0, "alt_m": 300.0}
    vehicles = [
        {"id": k, "label": f"<script>{k}</script>", "position": place, "heading_rad": 0.3}
        for k in (1, 2)
    ]
    rows = [row(r.id, Outcome.HOLDS, 1.0) for r in REQUIREMENTS]
    rows[0]["kernels"], rows[1]["kernels"] = ["a.k"], ["b.k"]
    manoeuvre = ["hs", 20.0, "m/s", "<9>", 1.5, 140.0, 3.0, 1.5]
    loss = {
        "own": 1, "other": 9, "lost_ms": 2000, "answer": "no way out", "why": "",
        "instants": [[1000, 1, 1, 1, 1]], "manoeuvres": [manoeuvre],
    }  # fmt: skip
    rows[1]["evidence"] = {"losses": [loss]}
    return {
        "verdict": "holds", "exit_code": 0, "product": {"version": "0"},
        "counts": {"holds": 5, "violated": 0, "unknown": 0, "excused": 0},
        "mission": {
            "name": "a<b>", "seed": 0, "vehicles": vehicles, "traffic": [], "relations": "|(p5)",
            "notes": ["note & more"], "daa": {"well_clear": {"dthr_m": 150.0}},
            "tasks": [{"id": 5, "label": "t", "points": [place, far], "radius_m": 0.0}],
            "zones": [{"id": 1, "kind": "keep_out", "vertices": [[9, 9], [99, 9], [9, 99]]}],
        },
        "mission_hash": "0" * 64, "command": "cratous run 'a<b>'", "avoidance": False,
        "not_covered": [2], "requirements": requirement_rows(rows), "constraints": rows,
        "assumptions": [
            {"name": "clock", "text": "<u>clock</u>", "theorems": ["t"], "guarantees": ["G5"],
             "state": "broken", "since_ms": 2500, "vehicle": None, "observed": 0.5, "bound": 0,
             "unit": "s back", "note": "back & forth", "lost": "all of it", "stands": "the rest",
             "checks": 3, "kernels": ["a.k"]},
            {"name": "told", "text": "told", "theorems": ["t"], "guarantees": ["G4"],
             "state": "not observed", "since_ms": None, "vehicle": None, "observed": None,
             "bound": None, "unit": "", "note": "no takeover", "lost": "", "stands": "",
             "checks": 0, "kernels": []},
        ],
        "plan": {
            "items": [
                {"task_id": 5, "vehicle_id": 1, "transit": [place], "path": [place, far],
                 "hold": {"north_m": 50.0, "east_m": 0.0, "radius_m": 30.0}, "depart_ms": 0,
                 "arrive_ms": 2500, "wait_ms": 0, "start_ms": 2500, "end_ms": 4000}
            ],
            "makespan_ms": 4000, "cost": "MINMAX", "nodes": 1, "exhausted": True, "hash": "1" * 64,
        },
        "flight": {
            "outcome": flight.outcome, "end_ms": flight.end_ms, "bars": bars(flight),
            "tracks": {str(k): track for k, track in flight.tracks.items()},
            "takeovers": flight.takeovers, "events": flight.events,
            "served": list(flight.served.values()), "unserved": [6],
        },
        "log": {"digest": "2" * 64, "messages": len(LOG), "by_topic": {}},
        "proofs": {
            "line": "1 kernel", "solver": "z3", "problems": [{"kernel": "k", "what": "changed"}],
            "calls": "recorded", "loops": {"c.loop": {"machine code": 4}}, "uncounted": [],
            "kernels": {
                "a.k": {"kind": "kernel", "count": 3, "how": {"CPython": 3}, "within": ["c.loop"],
                        "status": "proved", "theorems": ["t"], "definition": "s.d", "step_of": "",
                        "restates": "", "checked_by": [], "source": "3" * 64},
            },
            "theorems": {"t": {"sentence": "It holds.", "status": "proved", "kernels": ["a.k"],
                               "lemmas": [], "obligations": 2, "assumptions": ["a"]}},
            "definitions": {"s.d": "spec/s.py"},
        },
        "limits": ["limit"],
        "environment": {"python": "3.11", "system": "S", "packages": {"numpy": "2"}},
    }  # fmt: skip


def test_the_page_is_whole_and_escaped() -> None:
    page = render(report())
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    assert "a&lt;b&gt;" in page
    for words in ("Flown with --allow-unproved", "Avoidance was switched off", "never ended",
                  "Not covered", "It holds.", "ICAROUS in command", "2" * 64,
                  "Losses of well clear", "no way out", "&lt;9&gt;",
                  "&lt;u&gt;clock&lt;/u&gt;", "since 2.5 s", "worst 0.5, bound 0 s back", "back &amp; forth",
                  "Without ground since then: all of it. Still holds: the rest."):  # fmt: skip
        assert words in page


def test_the_page_tells_the_code_and_the_ledger() -> None:
    data = report()
    code = {
        "digest": "4" * 64,
        "running": "as its files say",
        "release": "no release to compare with",
    }
    data["environment"]["code"], data["proofs"]["seal"] = code, "5" * 64
    page = render(data)
    for words in ("4" * 16, "as its files say", "no release to compare with", "5" * 16,
                  "<code>cratous certify --argument</code> writes <code>argument.yaml</code>"):  # fmt: skip
        assert words in page


def test_the_page_loads_nothing() -> None:
    page = render(report())
    assert not re.search(r"""src\s*=|href\s*=(?!"#)|url\(|@import|https?://""", page)
    assert "default-src 'none'" in page


def test_the_page_is_well_formed() -> None:
    from lxml import html

    page = html.document_fromstring(render(report()))
    assert len(page.findall(".//svg")) > 3
    assert page.find(".//title").text == "a<b>: holds"


def test_a_row_leads_to_its_kernel_and_on_to_theorem_and_definition() -> None:
    from lxml import html

    page = html.document_fromstring(render(report()))
    targets = {node.get("id") for node in page.xpath("//*[@id]")}
    links = {node.get("href") for node in page.xpath("//a")} - {"#assumptions"}
    evidence = {"#kernel-a.k", "#theorem-t", "#definition-s.d"}
    # each requirement leads to the constraint that it is told by
    assert links == evidence | {f"#constraint-{k}" for k in range(1, 6)}
    assert {link[1:] for link in links} <= targets
    rows = page.xpath("//section[@id='answer']//table[1]//tr[td]")
    for row in rows:
        (link,) = row.xpath("./td[2]/a/@href")
        (told,) = page.xpath(f"//tr[@id='{link[1:]}']/td[1]")
        assert row.xpath("./td[1]/b")[0].text.startswith(told.text)
    decided = [
        node.text_content()
        for node in page.xpath("//h2[.='Constraints']/following::table[1]//td[6]")
    ]
    assert decided[0].startswith("a.k")
    assert decided[1].startswith("b.k (not called)")
    assert decided[2].startswith("no kernel: the messages say it")
    beside = [row.xpath("string(./td[1]/b)")[:2] for row in rows if row.xpath("./td[4]//a")]
    assert beside == ["G5"], "a broken assumption stands beside what it is about"
    (kernel,) = page.xpath("//tr[@id='kernel-a.k']")
    assert "compiled into c.loop (4 calls)" in kernel.text_content()
    assert "3 CPython" in kernel.text_content()


def test_nothing_is_evidence_where_calls_were_not_recorded() -> None:
    whole = report()
    whole["proofs"] |= {
        "calls": "not recorded", "kernels": {}, "loops": {}, "theorems": {}, "definitions": {},
    }  # fmt: skip
    page = render(whole)
    assert "was not recorded" in page
    assert 'b.k</span> <span class="soft">(calls not recorded)' in page
    assert '<a class="mono"' not in page, "nothing leads to evidence that is not there"


def test_the_map_keeps_one_scale_and_north_up() -> None:
    whole, site = report(), {"name": "s", "north_m": 200.0, "east_m": 100.0, "radius_m": 50.0}
    whole["mission"]["daa"]["link_loss"] = {"sites": [site]}
    view = map_view(whole)
    (task,) = view["tasks"]
    (x0, y0), (x1, y1) = (map(float, pair.split(",")) for pair in task["points"].split())
    assert x1 > x0, "east is right"
    assert y1 < y0, "north is up"
    assert abs((x1 - x0) / 200 - (y0 - y1) / 400) < 1e-3
    said = [view["sites"][0][k] for k in "xyr"]
    assert said == pytest.approx([(x0 + x1) / 2, (y0 + y1) / 2, (x1 - x0) / 4], abs=0.1)
    assert [piece["icarous"] for piece in view["tracks"][0]["pieces"]] == [False, True]
    kilometres = re.fullmatch(r"(\d+) (k?)m", view["bar"]["text"])
    assert kilometres
    metres = int(kilometres[1]) * (1000 if kilometres[2] else 1)
    assert abs(view["bar"]["length"] / metres - (x1 - x0) / 200) < 1e-2


def test_texts_of_the_map_are_on_it_and_over_no_other() -> None:
    whole = report()
    place = whole["mission"]["tasks"][0]["points"][0]
    whole["mission"]["tasks"] = [
        {"id": k, "label": "t", "points": [{**place, "north_m": 2.0 * k}], "radius_m": 0.0}
        for k in (5, 6, 7)
    ]
    east = max(v["position"]["east_m"] for v in whole["mission"]["vehicles"]) + 390.0
    whole["mission"]["changes"] = [
        {"at_ms": 1000 * k, "zone": {"id": 100 + k, "kind": "keep_out", "vertices": corners}}
        for k, corners in enumerate(
            [[[9, east], [19, east], [9, east + 9]]] * 3 + [[[1, 1], [9, 1], [1, 9]]] * 3
        )
    ]
    view = map_view(whole)
    said = [t["said"] for t in view["tasks"]] + [z["said"] for z in view["zones"] if z["said"]]
    assert len(said) == 9
    boxes = [
        (t["x"], t["y"] - LETTER[1], t["x"] + LETTER[0] * len(t["text"]), t["y"]) for t in said
    ]
    for k, (left, high, right, low) in enumerate(boxes):
        assert left >= 0, said[k]
        assert right <= view["width"], said[k]
        assert 0 <= high < low <= view["height"], said[k]
        for other in boxes[:k]:
            apart = right <= other[0] or other[2] <= left or low <= other[1] or other[3] <= high
            assert apart, said[k]
    assert view["zones"][1]["said"]["text"] == "zone 100, from 0 s"
    assert view["zones"][0]["said"] is None, "one that is always there needs no words"
    assert "1 zone and 6 that appear," in render(whole)


def test_the_last_tick_is_on_the_sheet() -> None:
    whole = report()
    whole["flight"]["end_ms"] = 300_100
    view = altitude_view(whole)
    assert view is not None
    last = view["times"][-1]
    assert last["text"] == "300 s"
    assert last["x"] > view["width"] - 20, "the rule is where the instant is"
    half_m = LETTER[0] * len(last["text"]) / 2
    assert last["text_x"] + half_m <= view["width"]


def test_time_line_and_separation() -> None:
    view = time_view(report())
    assert all(bar["x"] >= 110 and bar["x"] + bar["width"] <= 700.2 for bar in view["bars"])
    assert separation_view(report())["curves"][0]["least_m"] == pytest.approx(100.0)  # type: ignore[index]


def test_altitudes_over_time() -> None:
    whole = report()
    whole["flight"]["tracks"]["1"][-1][3] = 360.0
    view = altitude_view(whole)
    assert view is not None
    assert [(c["low_m"], c["high_m"]) for c in view["curves"]] == [(300.0, 360.0), (300.0, 300.0)]
    levels = {level["text"]: level["y"] for level in view["levels"]}
    ys = [float(pair.split(",")[1]) for pair in view["curves"][0]["points"].split()]
    assert ys[0] == levels["300 m"]
    assert ys[-1] < ys[0], "up is up"
    assert min(levels.values()) < min(ys), "no line lies on the frame"
    assert max(levels.values()) > max(ys)
    whole["flight"]["tracks"] = {}
    assert altitude_view(whole) is None
    assert separation_view(whole) is None


def test_the_nearest_pairs_come_first_traffic_among_them() -> None:
    whole = report()
    tracks = whole["flight"]["tracks"]
    whole["flight"]["tracks"] |= {
        str(k): [[t, n, e + 10.0 * k, alt + 50.0, 0] for t, n, e, alt, _ in tracks["2"]]
        for k in range(90, 99)
    }
    view = separation_view(whole)
    assert view is not None
    found = [curve["least_m"] for curve in view["curves"]]
    assert found == sorted(found)
    assert (len(found), view["pairs"]) == (FEW, 1 + 2 * 9), "no pair of traffic with traffic"
    assert view["curves"][0]["pair"] == "1 and 2"
    assert view["curves"][1]["above_m"] == 50.0
    assert f"nearest {FEW} of 19 pairs" in render(whole)


def test_a_requirement_without_margins_is_told_by_what_most_was_seen_for() -> None:
    rows = [row("G4", Outcome.HOLDS) for _ in range(3)]
    for one, checks in zip(rows, (3, 158, 4), strict=True):
        one["margin"], one["checks"], one["note"] = None, checks, f"{checks} checks"
    assert requirement_rows(rows)[3]["note"] == "158 checks"


def test_paper_has_the_answer_and_the_inventory_only_when_asked_for() -> None:
    from lxml import html

    text = render(report())
    page = html.document_fromstring(text)
    needed = {node.get("id"): node for node in page.xpath("//section[@class='by-need']")}
    assert set(needed) == {"constraints", "evidence", "events"}
    sheet = page.xpath("//style")[0].text.partition("@media print")[2]
    assert ".by-need { display: none; }" in sheet
    assert ".screen { display: none; }" in sheet
    assert "#flight" not in sheet, "what follows the answer begins where there is room"
    assumed = page.xpath("//h2[@id='assumptions']/following::table[1]//tr[td]")
    assert [row.get("class") for row in assumed] == [None, "screen"], "broken ones are printed"
    assert ".by-need:target, .by-need:has(:target) { display: block;" in sheet
    (answer,) = page.xpath("//section[@id='answer']")
    titles = [node.text for node in answer.xpath(".//h2")]
    assert titles == ["Requirements", "Reproduce", "Not covered"]
    assert len(answer.xpath(".//svg[@role='img']")) == 3, "map, altitudes, closest approaches"
    assert not re.search(r"\d:\d\d\.\d", text), "times are written one way"
