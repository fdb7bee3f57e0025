"""Who is the most urgent aircraft, and implicit coordination in files, words and errors."""

from __future__ import annotations

import dataclasses
import json
import random
from pathlib import Path

import pytest
from daa_pairs import NUMBERS, VECTORS, coordinating, meeting
from hypothesis import assume, given

from cratous.core.daa.session import Session
from cratous.core.daa.state import Aircraft
from cratous.core.daa.urgency import nearest
from cratous.core.kernel import Vec2
from cratous.services import cli
from cratous.services.daa import named_or_file, run
from cratous.services.daa.explain import explain
from cratous.services.daa.tables import as_data
from cratous.spec.daa import conf_files as daa_conf
from cratous.spec.daa.parameters import DCPA, FIXED, NMAC_HALF_HEIGHT_M, NMAC_RADIUS_M, Parameters
from cratous.spec.daa.presets import preset
from cratous.spec.errors import BadInput

SIZE = (NMAC_RADIUS_M, NMAC_HALF_HEIGHT_M)


@pytest.fixture(scope="module")
def p() -> Parameters:
    return dataclasses.replace(preset("do_365b").parameters, hysteresis_time_s=0.0)


# -- urgency ----------------------------------------------------------------------------------
@given(VECTORS, VECTORS, NUMBERS, NUMBERS)
def test_nobody_comes_nearer_than_the_nearest(s: Vec2, v: Vec2, sz: float, vz: float) -> None:
    # a slower one would not have moved by a nanometre when the universe ends, and squares to nothing
    assume(all(x == 0 or abs(x) > 1e-100 for x in (*s, *v, sz, vz)))
    own = Aircraft("own", *s, sz, *v, vz)
    size, time_s = nearest(own, Aircraft("i", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert time_s >= 0

    def at(t: float) -> float:
        x, y, z = s.x + t * v.x, s.y + t * v.y, sz + t * vz
        return max((x * x + y * y) / SIZE[0] ** 2, (z / SIZE[1]) ** 2)

    assert size == pytest.approx(at(time_s))
    for t in (0.0, 0.5, 7.0, 60.0, 3600.0, time_s * 0.99, time_s * 1.01, time_s + 0.01):
        assert size <= at(t) * (1 + 1e-6) + 1e-9


def test_the_most_urgent_is_who_comes_nearest(p: Parameters) -> None:
    on = dataclasses.replace(p, conflict_crit=True, urgency_strategy=DCPA)
    own = Aircraft("own", 0.0, 0.0, 3000.0, 0.0, 100.0, 0.0)
    wide = Aircraft("wide", 900.0, 5000.0, 3000.0, 0.0, -100.0, 0.0)
    late = Aircraft("late", 50.0, 9000.0, 3000.0, 0.0, -100.0, 0.0)
    soon = late._replace(id="soon", north_m=7000.0)
    for others, expected in (
        ([wide], "wide"),
        ([wide, late], "late"),
        ([late, soon, wide], "soon"),
    ):
        for order in (others, others[::-1]):
            found = Session(on).step(0.0, own, order).seen.coordination
            assert found is not None
            assert found.id == expected
    assert Session(on).step(0.0, own, []).seen.coordination is None


# -- files, words, errors -----------------------------------------------------------------------
def test_the_keys_are_read_and_written() -> None:
    made = daa_conf.parse(
        "conflict_crit = true\nurgency_strategy = fixed\nmost_urgent_aircraft = A-1"
    )
    p = made.parameters
    assert (p.conflict_crit, p.urgency_strategy, p.most_urgent_aircraft) == (True, FIXED, "A-1")
    assert daa_conf.parse(daa_conf.write(made)).parameters == p
    plain = daa_conf.write(daa_conf.parse(""))
    assert "conflict_crit = false" in plain
    assert "urgen" not in plain, "keys of ours are written only where they say something"


@pytest.mark.parametrize(
    ("text", "item", "says"),
    [
        ("urgency_strategy = fixed", "most_urgent_aircraft", "got none with fixed"),
        ("most_urgent_aircraft = A", "most_urgent_aircraft", "got A with none"),
        (
            "urgency_strategy = dcpa\nmost_urgent_aircraft = A",
            "most_urgent_aircraft",
            "A with dcpa",
        ),
        ("urgency_strategy = nearest", "urgency_strategy", "none or fixed or dcpa"),
        ("conflict_crit = 1", "conflict_crit", "true or false"),
    ],
)
def test_what_does_not_fit_is_refused(text: str, item: str, says: str) -> None:
    with pytest.raises(BadInput) as caught:
        daa_conf.parse(text, "c")
    assert caught.value.item == item
    assert says in str(caught.value)


def test_an_unknown_aircraft_is_refused(p: Parameters, root: Path) -> None:
    file = root / "examples/encounters/two_intruders.daa"
    with pytest.raises(BadInput) as caught:
        list(run(file, coordinating(p, "nobody")))
    assert caught.value.item == "most_urgent_aircraft"
    assert caught.value.got == "nobody"
    own, other = meeting(random.Random(1))
    with pytest.raises(BadInput) as caught:
        Session(coordinating(p, "own")).step(0.0, own, [other])
    assert caught.value.got == "own"


def test_an_edge_of_coordination_says_so(p: Parameters) -> None:
    own = Aircraft("own", 0.0, 0.0, 3000.0, 0.0, 100.0, 0.0)
    other = Aircraft("intruder", 100.0, 6000.0, 3000.0, 0.0, -100.0, 0.0)
    on = coordinating(p, "intruder")
    instant = Session(on).step(0.0, own, [other])
    lines = explain(on, instant)
    said = next(x for x in lines if x.startswith("coordination:"))
    assert "intruder is most urgent (urgency strategy fixed)" in said
    assert "on the right hand" in said
    assert "conflict and recovery bands" in said
    begin = next(k for k, x in enumerate(lines) if x.startswith("hdir: edge"))
    assert any("intruder: coordination:" in x for x in lines[begin : begin + 8])
    data = as_data(instant)
    # "intruder" is before "own", so at one altitude it goes above
    assert data["coordination"] == {"id": "intruder", "horizontal": 1, "vertical": -1}
    none = dataclasses.replace(on, urgency_strategy=0, most_urgent_aircraft="")
    lines = explain(none, Session(none).step(0.0, own, [other]))
    assert "coordination: nobody is most urgent now (urgency strategy none)" in lines
    assert not any("coordination" in x for x in explain(p, Session(p).step(0.0, own, [other])))


def test_the_command_takes_the_strategy(root: Path, tmp_path: Path, capsys) -> None:
    file = str(root / "examples/encounters/two_intruders.daa")
    conf = tmp_path / "c.conf"
    text = daa_conf.write(named_or_file("do_365b"))
    conf.write_text(text.replace("_crit = false", "_crit = true"))
    rows = [
        r for _, r in zip(range(2), run(Path(file), preset("do_365b").parameters), strict=False)
    ]
    name = rows[0].rows[1].id
    assert cli.main(["daa", "explain", file, "-c", str(conf), "--urgent", name, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["coordination"]["id"] == name
    assert cli.main(["daa", "explain", file, "-c", str(conf), "--urgency", "dcpa", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["coordination"] is not None
    assert cli.main(["daa", "bands", file, "-c", str(conf), "--urgent", "nobody"]) == 2
    assert "nobody" in capsys.readouterr().err
    assert cli.main(["daa", "bands", file, "-c", str(conf), "--urgency", "fixed"]) == 2


def test_a_strategy_without_a_criterion_is_refused(root: Path, capsys) -> None:
    file = str(root / "examples/encounters/two_intruders.daa")
    assert cli.main(["daa", "bands", file, "-c", "do_365b", "--urgency", "dcpa"]) == 2
    said = capsys.readouterr().err
    assert "urgency_strategy" in said
    assert "conflict_crit or recovery_crit = true" in said


def test_a_strategy_serves_where_one_step_turns_a_criterion_on(tmp_path: Path, capsys) -> None:
    file = tmp_path / "late.daa"
    rows = [
        f"{name}, {time}, {sx}, 0, 3000, {trk}, 300, 0, {crit}"
        for time, crit in ((0, "false"), (1, "true"))
        for name, sx, trk in (("own", 0, 90), ("other", 4, 270))
    ]
    head = "NAME, time, sx, sy, sz, trk, gs, vs, conflict_crit\n"
    units = "[none], [s], [nmi], [nmi], [ft], [deg], [knot], [fpm], [none]\n"
    file.write_text(head + units + "\n".join(rows) + "\n")
    asked = ["daa", "bands", str(file), "-c", "do_365b", "--urgency", "dcpa"]
    assert cli.main(asked) == 0, capsys.readouterr().err
    file.write_text(file.read_text().replace("true", "false"))
    assert cli.main(asked) == 2
