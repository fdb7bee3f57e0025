"""Conducting a campaign: nothing is flown twice, what is lost is said, the bytes are the same."""

from __future__ import annotations

import base64
import csv
import io
import re
import sqlite3
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import campaign_child
import pytest
from campaign_child import FUNCTION, flown, written

from cratous.services.campaign import worker
from cratous.services.campaign.campaign import Conduct, Course
from cratous.services.campaign.definition import Campaign, Option, load_campaign
from cratous.services.campaign.engine import Answer, here, refuse_other_version
from cratous.services.campaign.identity import version_digest
from cratous.services.campaign.outcomes import code_of, outcome_of, row_of
from cratous.services.campaign.pages import page
from cratous.services.campaign.runs import runs_of
from cratous.services.campaign.store import Store
from cratous.services.campaign.summary import build, text_of
from cratous.services.campaign.tables import csv_text, junit_text, parquet_bytes
from cratous.services.cli import campaign as command
from cratous.services.cli import main
from cratous.spec.errors import BadInput, Refused

VARIED = "seeds: [1, 12]\nvary: [{item: 'vehicles[0].speed_m_s', range: [10, 40]}]\n"
OPTIONS = "options: [{name: a}, {name: b, daa: false}]\n"


@pytest.fixture(autouse=True)
def _child(monkeypatch: pytest.MonkeyPatch, root: Path) -> None:
    monkeypatch.setenv("PYTHONPATH", f"{root / 'tests' / 'children'}:{root / 'src'}")


def at_once(feed: Any) -> Any:
    """An engine without processes."""
    while (task := feed()) is not None:
        yield Answer(task, {"result": campaign_child.fly(task["run"])})


def conduct(campaign: Campaign, folder: Path, engine: Any = at_once) -> tuple[str, Course]:
    """campaign.json, and how it went."""
    with Store(folder) as store:
        one = Conduct(campaign, store, FUNCTION, version_digest(), False)
        course = Course(0)
        one.fly(engine, course, lambda _text: None)
        return text_of(build(campaign, list(one.rows()), "v")), course


def test_what_is_stored_is_not_flown_again(tmp_path: Path) -> None:
    campaign = load_campaign(written(tmp_path, {"plain": ""}, VARIED + OPTIONS), None, ())
    flights: list[str] = []

    def stops(feed: Any) -> Any:
        for answer in at_once(feed):
            flights.append(answer.task["id"])
            yield answer
            if len(flights) == 7:
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        conduct(campaign, tmp_path / "one", stops)
    resumed, course = conduct(campaign, tmp_path / "one")
    whole, _ = conduct(campaign, tmp_path / "two")
    assert (course.stored, course.flown) == (7, 17)
    assert resumed == whole


def test_the_order_of_answers_changes_nothing(tmp_path: Path) -> None:
    campaign = load_campaign(written(tmp_path, {"plain": ""}, VARIED + OPTIONS), None, ())

    def backwards(feed: Any) -> Any:
        tasks = []
        while (task := feed()) is not None:
            tasks.append(task)
        for task in reversed(tasks):
            yield Answer(task, {"result": campaign_child.fly(task["run"])}, died=1)

    one, course = conduct(campaign, tmp_path / "one", backwards)
    two, _ = conduct(campaign, tmp_path / "two")
    assert one == two
    assert course.lost == 24, "said, and in no byte of the summary"


def test_each_way_to_be_lost_costs_one_attempt_and_is_said(tmp_path: Path) -> None:
    missions = {
        "dies": f"die {tmp_path}/dies", "hangs": f"hang {tmp_path}/hangs",
        "eats": f"eat {tmp_path}/eats", "always": "die", "good": "",
    }  # fmt: skip
    rest = "limits: {time_s: 15, memory_mb: 400, attempts: 2}\n"
    campaign = load_campaign(written(tmp_path, missions, rest), None, ())
    with here() as engine:
        text, course = conduct(campaign, tmp_path / "out", engine)
    with Store(tmp_path / "out") as store:
        runs = {run.mission: run for run in runs_of(campaign, version_digest(), False)}
        lost = {name: store.lost(run.id) for name, run in runs.items()}
        assert store.result(runs["always"].id) is None
    assert [why.partition(" (")[0] for why in lost["dies"]] == ["its process died"]
    assert lost["hangs"] == ["took longer than its limit"]
    assert lost["eats"] == ["out of memory"]
    assert len(lost["always"]) == 2
    assert lost["good"] == []
    assert course.outcomes == {"holds": 4, "lost": 1}
    assert '"lost": 1' in text
    assert '"exit_code": 3' in text


def test_another_version_is_refused() -> None:
    refuse_other_version({"result": {}}, "a worker")
    with pytest.raises(Refused, match="another version"):
        refuse_other_version({"other version": "abc"}, "a worker")


def test_a_flier_of_another_version_flies_nothing(tmp_path: Path) -> None:
    campaign = load_campaign(written(tmp_path, {"plain": f"die {tmp_path}/flown"}, ""), None, ())
    with Store(tmp_path / "out") as store, here() as engine:
        one = Conduct(campaign, store, FUNCTION, "0" * 64, False)
        with pytest.raises(Refused, match="another version"):
            one.fly(engine, Course(1), lambda _text: None)
        assert all(store.result(run.id) is None for run in one.runs())
    assert not (tmp_path / "flown").exists()


def test_a_version_that_changed_between_flight_and_report_is_told_as_that(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    campaign = load_campaign(written(tmp_path, {"plain": ""}, ""), None, ())
    monkeypatch.setattr(worker, "attempt", lambda _task: {"other version": "1" * 64})
    with Store(tmp_path / "out") as store:
        one = Conduct(campaign, store, FUNCTION, "0" * 64, False)
        one.fly(at_once, Course(1), lambda _text: None)
        with pytest.raises(Refused, match="have changed since the campaign was begun") as told:
            command._reports(one, list(one.rows()), campaign, tmp_path, 1, lambda _text: None)
    assert "gives another result" not in str(told.value)


def test_two_campaigns_do_not_write_into_one_folder(tmp_path: Path) -> None:
    with Store(tmp_path), pytest.raises(BadInput, match="another campaign"):
        Store(tmp_path)


@pytest.mark.parametrize("content", [b"no database at all, whatever its name", None])
def test_what_is_no_store_is_refused(tmp_path: Path, content: bytes | None) -> None:
    file = tmp_path / "runs.sqlite"
    if content is None:
        database = sqlite3.connect(file)
        database.execute("CREATE TABLE mine(x)")
        database.commit()
        database.close()
    else:
        file.write_bytes(content * 100)
    before = file.read_bytes()
    with pytest.raises(BadInput):
        Store(tmp_path)
    assert file.read_bytes() == before


def test_a_full_disk_stops_it_and_it_goes_on_later(tmp_path: Path) -> None:
    campaign = load_campaign(written(tmp_path, {"plain": ""}, VARIED), None, ())
    with Store(tmp_path / "out") as store:
        one = Conduct(campaign, store, FUNCTION, version_digest(), False)
        store._db.execute("PRAGMA max_page_count=5")
        with pytest.raises(BadInput, match="the disk is full"):
            one.fly(at_once, Course(12), lambda _text: None)
    resumed, course = conduct(campaign, tmp_path / "out")
    assert course.stored > 0
    assert course.stored + course.flown == 12
    assert resumed == conduct(campaign, tmp_path / "new")[0]


def judged(**more: Any) -> dict[str, Any]:
    result = flown({"G2": 10.0})
    result["judge"].update(more)
    return result


def fitting(fits: bool | None) -> dict[str, Any]:
    return {"fits": fits, "events": 9, "why": "" if fits else "x"}


DIFFERENCE = {"guarantee": "G2", "item": "x", "judge": "violated", "monitor": "holds", "note": ""}


@pytest.mark.parametrize(
    ("result", "outcome"),
    [
        (flown({"G2": 10.0}), "holds"),
        (flown({"G2": -1.0}), "violated"),
        (flown({"G2": 10.0}, proved=False), "unknown"),
        (judged(disagreements=[DIFFERENCE]), "disagreement"),
        (judged(guarantees={"G2": "unknown"}), "unknown"),
        ({**flown({}), "judge": {"refused": "a cut log"}}, "unknown"),
        ({**flown({"G2": 10.0}), "model": fitting(False)}, "misfit"),
        ({**flown({"G2": -1.0}), "model": fitting(False)}, "misfit"),
        ({**flown({"G2": 10.0}), "model": fitting(True)}, "holds"),
        ({**flown({"G2": 10.0}), "model": fitting(None)}, "holds"),
        ({"kind": "no plan", "why": ["x"]}, "no plan"),
        (None, "lost"),
    ],
)
def test_what_is_not_shown_never_holds(result: dict[str, Any] | None, outcome: str) -> None:
    assert outcome_of(result, ("G1", "G2")) == outcome


def test_exit_codes() -> None:
    assert code_of({"holds"}) == 0
    assert code_of({"holds", "violated", "lost"}) == 1
    assert code_of({"holds", "disagreement"}) == code_of({"holds", "misfit"}) == 1
    for other in ("lost", "unknown", "excused", "impossible", "failed"):
        assert code_of({"holds", other}) == 3
    assert code_of(set()) == 3


def summary_of(tmp_path: Path, results: list[dict[str, Any] | None]) -> dict[str, Any]:
    """Of a campaign of one option with these results."""
    rest = f"seeds: [1, {len(results)}]\nvary: [{{item: daa.buffer, range: [1, 2]}}]\n"
    campaign = load_campaign(written(tmp_path, {"plain": ""}, rest), None, ())
    runs = runs_of(campaign, "v", False)
    rows = [row_of(run, r, campaign.requirements) for run, r in zip(runs, results, strict=True)]
    return build(campaign, rows, "v")


def test_the_summary_counts_apart_what_was_not_flown(tmp_path: Path) -> None:
    impossible = {"kind": "impossible", "why": ["vehicle 1 starts inside keep-out zone 1"]}
    results = [
        flown({"G2": 10.0}),
        flown({"G2": -4.0}),
        impossible,
        {"kind": "no plan", "why": ["x"]},
    ]
    found = summary_of(tmp_path, [*results, None])
    (group,) = found["groups"]
    assert found["outcomes"] == {
        "violated": 1, "no plan": 1, "lost": 1, "impossible": 1, "holds": 1,
    }  # fmt: skip
    assert (group["not_holding"]["count"], group["not_holding"]["of"]) == (3, 4)
    assert (group["requirements"]["G2"]["violated"]["count"], group["flown"]) == (1, 2)
    assert found["worst"] == ["plain-as-written-seed2", "plain-as-written-seed1"]
    assert {r["why"] for r in found["reasons"]} >= set(impossible["why"])
    bins = found["covered"]["daa.buffer"]["bins"]
    assert (sum(b[0] for b in bins), sum(b[1] for b in bins)) == (2, 1)


def test_disagreement_is_seen_even_where_it_is_not_required(tmp_path: Path) -> None:
    found = summary_of(tmp_path, [judged(disagreements=[DIFFERENCE]), flown({"G2": 1.0})])
    assert found["disagreements"] == 1
    assert page(found, {}).index("DISAGREEMENT") < page(found, {}).index("<h1>")


def test_options_are_compared_on_the_same_seeds(tmp_path: Path) -> None:
    campaign = load_campaign(written(tmp_path, {"plain": ""}, VARIED + OPTIONS), None, ())
    assert campaign.options == (Option("a"), Option("b", daa=False))
    rows = []
    for run in runs_of(campaign, "v", False):
        rows.append(row_of(run, campaign_child.fly(run.decides), campaign.requirements))
    (one,) = build(campaign, rows, "v")["comparisons"]
    found = one["requirements"]["G2"]
    slow = sum(r.drawn["vehicles[0].speed_m_s"] <= 30 for r in rows) // 2
    assert (found["pairs"], found["first_only"], found["second_only"]) == (12, slow, 0)
    assert found["gain_m"]["count"] == 12


def test_csv_and_junit_say_the_same(tmp_path: Path) -> None:
    results = [
        flown({"G2": 10.0}),
        flown({"G2": -4.0}),
        {"kind": "failed", "why": ["=cmd|' /C calc'!A0"]},
    ]
    found = summary_of(tmp_path, [*results, {"kind": "impossible", "why": ["@x"]}])
    rows = list(csv.DictReader(io.StringIO(csv_text(found))))
    assert [row["outcome"] for row in rows] == ["holds", "violated", "failed", "impossible"]
    assert [row["G2 margin"] for row in rows] == ["10.0", "-4.0", "", ""]
    assert rows[2]["why"].startswith("'=")
    assert rows[3]["why"] == "'@x"
    suite = ElementTree.fromstring(junit_text(found)).find("testsuite")
    assert suite is not None
    counts = {key: suite.get(key) for key in ("tests", "failures", "errors", "skipped")}
    assert counts == {"tests": "4", "failures": "1", "errors": "1", "skipped": "1"}


def test_parquet_says_what_csv_says(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow", reason="the extra `parquet` is not installed")
    import pyarrow.parquet

    failed = {"kind": "failed", "why": ["=cmd"]}
    found = summary_of(tmp_path, [flown({"G2": 10.5}), flown({"G2": -4.0}), failed])
    for run, (speed, side) in zip(
        found["runs"], [(20, 1), (21.5, "left"), (22, None)], strict=True
    ):
        run["drawn"] = {"speed": speed, "side": side, "large": 2**53 + 1}
    (tmp_path / "runs.parquet").write_bytes(parquet_bytes(found))
    table = pyarrow.parquet.read_table(tmp_path / "runs.parquet")
    texts = csv.reader(io.StringIO(csv_text(found)))
    assert table.column_names == next(texts)
    assert [table["G2 margin"].to_pylist(), table["outcome"].to_pylist()] == [
        [10.5, -4.0, None], ["holds", "violated", "failed"],
    ]  # fmt: skip
    assert table["why"].to_pylist()[2] == "=cmd", "as it is: programs run no formula"
    assert table["speed"].to_pylist() == [20.0, 21.5, 22.0]
    assert table["side"].to_pylist() == ["1", "left", None]
    assert table["large"].to_pylist() == [str(2**53 + 1)] * 3, "no double is that number"
    kinds = {
        name: str(table.schema.field(name).type) for name in ("seed", "takeovers", "separation_m")
    }
    assert kinds == {"seed": "int64", "takeovers": "int64", "separation_m": "double"}
    assert parquet_bytes(found) == (tmp_path / "runs.parquet").read_bytes()


def test_a_parquet_table_of_other_runs_does_not_stay(tmp_path: Path) -> None:
    (tmp_path / "runs.parquet").write_bytes(b"of the runs of before")
    command._write(summary_of(tmp_path, [flown({"G2": 10.5})]), tmp_path, {})
    assert not (tmp_path / "runs.parquet").exists()
    assert (tmp_path / "runs.csv").exists()


def test_parquet_without_its_library_is_told_before_anything_is_flown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    file = written(tmp_path, {"plain": ""}, VARIED)
    assert main(["campaign", str(file), "-o", str(tmp_path / "out"), "--parquet"]) == 2
    assert "pyarrow is not installed; expected the extra 'parquet'" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    words = ["campaign", str(file), "-o", str(tmp_path / "out"), "--find", "G2", "--parquet"]
    assert main(words) == 2
    assert "not of --find" in capsys.readouterr().err


def test_the_page_is_whole_and_loads_nothing(tmp_path: Path) -> None:
    results = [flown({"G2": float(k)}) for k in range(-2, 20)]
    results[5]["judge"]["refused"] = "<script>alert(1)</script>"
    found = summary_of(tmp_path, list(results))
    links = {"plain-as-written-seed1": "flights/plain-as-written-seed1/report.html"}
    text = page(found, links, {"plain-as-written-seed1": b"<svg>map</svg>"})
    assert "<script" not in text
    assert text.count("<img") == page(found, links).count("<img") + 1 == 1
    picture = re.search(r'<img alt="Map of (.*)" src="data:image/svg\+xml;base64,(.*)">', text)
    assert picture is not None
    assert (picture[1], base64.b64decode(picture[2])) == (next(iter(links)), b"<svg>map</svg>")
    assert "http" not in text.replace("http://www.w3.org", "")
    assert 'href="flights/plain-as-written-seed1/report.html"' in text
    assert text.count("<circle") == 22
    assert "2 of 22: 9.09 % (1.12 to 29.2 %)" in text
