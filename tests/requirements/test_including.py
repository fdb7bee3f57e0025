"""Files of requirements that include others: names, parameters, bounds, and the product's libraries."""

from __future__ import annotations

from pathlib import Path

import pytest

from cratous.services.cli import main
from cratous.services.requirements import including
from cratous.services.requirements.formula import same
from cratous.services.requirements.including import libraries, library_text
from cratous.services.requirements.language import read
from cratous.services.requirements.requirement_files import files_of, other_libraries, own_file
from cratous.services.requirements.specification import NotRead, Specification
from cratous.services.requirements.watch import watch
from cratous.spec.errors import BadInput

LOW = """parameter vehicle: id
parameter floor: m is 90 m
parameter within: s is 5 s
signal z: m from AirVehicleState[ID=$vehicle].Location.Altitude hold $within
signal unused: m from AirVehicleState[ID=$vehicle].Location.Altitude
requirement FLOOR "never low" severity major: z >= $floor
requirement SOON: z < $floor + 10 m implies eventually within $within z > 2 * $floor
"""
TOP = """trace every 500 ms gap 600 ms
include "common/low.req" as one with vehicle is 1
include "common/low.req" as two only SOON with vehicle is 2, floor is 300 ft, within is 2000 ms
requirement BOTH: one.z >= two.z
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "common").mkdir()
    (tmp_path / "common" / "low.req").write_text(LOW)
    return tmp_path


def spec_of(folder: Path, text: str) -> Specification:
    return read(text, "top.req", folder)


def test_ids_signals_and_parameters(folder: Path) -> None:
    spec = spec_of(folder, TOP)
    assert [one.name for one in spec.requirements] == ["one.FLOOR", "one.SOON", "two.SOON", "BOTH"]
    assert set(spec.signals) == {"one.z", "two.z"}, "what nobody uses is not there"
    assert spec.signals["two.z"].chosen == (("ID", "2"),)
    assert (spec.signals["one.z"].hold_ns, spec.signals["two.z"].hold_ns) == (5 * 10**9, 2 * 10**9)
    plain = spec_of(folder, """trace every 500 ms gap 600 ms
        signal z: m from AirVehicleState[ID=2].Location.Altitude hold 2 s
        requirement SOON: z < 101.44 m implies eventually within 2 s z > 182.88 m""")  # fmt: skip
    renamed = spec_of(
        folder, TOP.replace("as two only", "only").replace("one.z >= two.z", "z >= 1 m")
    )
    assert same(renamed.requirements[2].formula, plain.requirements[0].formula)  # type: ignore[arg-type]
    assert "z < 300 ft + 10 m implies eventually within 2000 ms" in spec.requirements[2].text
    assert spec.requirements[0].severity == "major"


def test_the_verdicts_are_those_of_one_file(folder: Path) -> None:
    rows = ["time_s,one.z,two.z", "0,100,200", "0.5,80,200", "1,200,190"]
    (folder / "t.csv").write_text("\n".join(rows) + "\n")
    (folder / "top.req").write_text(TOP)
    found = watch(spec_of(folder, TOP), folder / "t.csv").outcomes
    assert {one.name: (one.holds, one.violated) for one in found} == {
        "one.FLOOR": (2, 1), "one.SOON": (3, 0), "two.SOON": (3, 0), "BOTH": (1, 2),
    }  # fmt: skip
    assert main(["check", str(folder / "top.req")]) == 0


def test_a_file_that_is_included_includes_from_where_it_lies(folder: Path) -> None:
    (folder / "other").mkdir()
    (folder / "other" / "more.req").write_text(
        'parameter v: id\ninclude "../common/low.req" as low only FLOOR with vehicle is $v\n'
        'include "link" as link only ALIVE with vehicle is $v\nrequirement MORE: low.z >= 1 m\n'
    )
    spec = spec_of(folder, 'include "other/more.req" as more with v is 7\n')
    assert [one.name for one in spec.requirements] == [
        "more.low.FLOOR",
        "more.link.ALIVE",
        "more.MORE",
    ]
    assert spec.signals["more.link.alive"].chosen == (("VehicleID", "7"),)
    kept = folder / "top.req"
    kept.write_text('include "other/more.req" as more with v is 7\n')
    own = own_file(kept, "top.req")
    assert [name for name, _ in own.imports] == ["common/low.req", "library link", "other/more.req"]
    (again,) = files_of([own.data()])
    assert again == own
    assert other_libraries([own]) == []
    said = own.data()
    said["imports"][1]["text"] += "# edited\n"
    with pytest.raises(BadInput, match="another digest"):
        files_of([said])
    edited = own._replace(
        imports=(own.imports[0], ("library link", own.imports[1][1] + "#\n"), own.imports[2])
    )
    assert other_libraries([edited]) == [
        "top.req: library link is another text than this version of CRATOUS has"
    ]
    missing = own.data()
    del missing["imports"][2]
    with pytest.raises(BadInput, match="not there"):
        files_of([missing])


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('include "common/low.req" with vehicle is 1\ninclude "common/low.req" with vehicle is 2', "a signal is declared twice"),
        ('include "common/low.req" as a with vehicle is 1\nrequirement a.FLOOR: a.z >= 1 m', "a requirement's id is given twice; got a.FLOOR"),
        ('signal z: m\ninclude "common/low.req" with vehicle is 1', "a signal is declared twice"),
        ('include "common/low.req" as a', "nothing gives this parameter a value; expected parameter vehicle: id is VALUE"),
        ('include "common/low.req" as a with vehicle is 1, height is 3 m', "the file has no such parameter; expected vehicle, floor, within; got height"),
        ('include "common/low.req" as a with vehicle is 1, floor is 3 s', "units that do not fit; expected length, as m; got s"),
        ('include "common/low.req" as a with vehicle is 1, vehicle is 2', "a value is given twice"),
        ('include "common/low.req" as a with vehicle is 1.5', "this is no id; expected digits; got 1.5"),
        ('include "common/low.req" as a only NONE with vehicle is 1', "the file has no such requirement; expected FLOOR, SOON; got NONE"),
        ('include "common/gone.req" as a', "there is no such file"),
        ('include "nothing" as a', "there is no such library; expected assumptions, authority"),
        ('include "/etc/low.req" as a', "this is no path from here"),
        ('include "common\\low.req" as a', "this is no path from here"),
        ('parameter p: m\nsignal z: m\nrequirement R: z >= $p', "nothing gives this parameter a value"),
        ('parameter p: m is 1 m\nparameter p: m is 1 m\nsignal z: m\nrequirement R: z >= $p', "declared twice"),
        ('signal z: m\nrequirement R: z >= $q', "this is no parameter; expected there is none; got $q"),
        ('parameter p: m is 1 m\nsignal z: m from T[ID=$p].x\nrequirement R: z >= 1 m', "a parameter that is an id"),
        ('parameter p: id is 1\nsignal z: m\nrequirement R: z >= $p', "an id is no number"),
        ('parameter p: m is 1 m\nsignal z: m\nrequirement R: always within $p z >= 1 m', "this is no time"),
        ('signal a.b: m\nrequirement R: a.b >= 1 m', "a signal has no dot in its name"),
        ('trace every 1 s\ninclude "other.req" as a', "the trace is described twice"),
    ],
)  # fmt: skip
def test_what_is_refused(folder: Path, text: str, says: str) -> None:
    (folder / "other.req").write_text("trace every 2 s\nsignal x: m\nrequirement X: x >= 1 m\n")
    with pytest.raises(BadInput) as no:
        spec_of(folder, text)
    where = str(no.value).partition(": ")[2] if isinstance(no.value, NotRead) else str(no.value)
    assert says in where or says in str(no.value), str(no.value)


def test_no_file_includes_itself_or_too_much(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for one, other in (("a", "b"), ("b", "a")):
        (folder / f"{one}.req").write_text(f'include "{other}.req" as x\n')
    with pytest.raises(
        NotRead, match=r"a file includes itself; got a\.req > b\.req > a\.req"
    ) as no:
        spec_of(folder, 'include "a.req" as x\n')
    assert no.value.where == f"{folder / 'b.req'}, line 1, column 9"
    end = "signal x: m\nrequirement R: x >= 1 m\n"
    for k in range(10):
        (folder / f"l{k}.req").write_text(end if k == 9 else f'include "l{k + 1}.req" as x\n')
    assert spec_of(folder, 'include "l2.req" as x\n').requirements
    with pytest.raises(NotRead, match="too much is included; expected 8 levels and 50 files"):
        spec_of(folder, 'include "l1.req" as x\n')
    many = "".join(f'include "l9.req" as x{k}\n' for k in range(51))
    with pytest.raises(NotRead, match="too much is included"):
        spec_of(folder, many)
    assert len(spec_of(folder, many.rpartition("include")[0]).requirements) == 50
    monkeypatch.setattr(including, "CONFIG_BYTES", 60)
    with pytest.raises(NotRead, match="what is included is too long"):
        spec_of(folder, 'include "l9.req" as x\ninclude "l9.req" as y\n')
    with pytest.raises(NotRead, match="lies in no folder"):
        read('include "l9.req" as x\n')


def test_an_error_names_the_file_that_has_it(folder: Path) -> None:
    (folder / "common" / "low.req").write_text(LOW.replace("z >= $floor", "z >= $within"))
    with pytest.raises(NotRead, match="units that do not fit; expected length, as m; got s") as no:
        spec_of(folder, TOP)
    assert no.value.where == f"{folder / 'common' / 'low.req'}, line 6, column 49"


HOLDS = {
    "keep-in": ("vehicle is 1, south is 0 m, north is 9 m, west is 0 m, east is 9 m, floor is 0 m, ceiling is 9 m, between is 1 m",
                {"n": (1, 0.9), "e": (8, 8.1), "altitude": (5, 8.5)}),
    "keep-out": ("vehicle is 1, south is 0 m, north is 9 m, west is 0 m, east is 9 m, floor is 0 m, ceiling is 9 m, between is 1 m",
                 {"n": (10.1, 10), "e": (5, 5), "altitude": (5, 5)}),
    "timing": ("vehicle is 1, task is 1, from is 1 s, by is 5 s",
               {"now": (2000, 6000), "active": (1, 1), "complete": (0, 0)}),
    "order": ("first is 1, second is 2", {"first_complete": (1, 0), "second_active": (1, 1), "second_complete": (0, 0)}),
    "well-clear": ("vehicle is 1, other is 2, distance is 5 m, height is 9 m",
                   {"north": (3, 3), "east": (4, 3.9), "altitude": (0, 0), "north_other": (0, 0), "east_other": (0, 0), "altitude_other": (8, 8)}),
    "progress": ("task is 1, by is 1 s", {"active": (1, 1), "complete": (0, 1)}),
    "authority": ("vehicle is 1, back is 1 s", {"icarous": (0, 1), "epoch": (0, 0)}),
    "link": ("vehicle is 1", {"now": (1000, 1001), "up": (0, 0), "down": (0, 500), "alive": (1, 1)}),
    "assumptions": ("vehicle is 1, limit is 10 min",
                    {"now": (500, 501), "down": (0, 0), "up_number": (1, 1), "icarous": (0, 0), "epoch": (0, 0)}),
}  # fmt: skip
BROKEN = {
    "keep-in": "INSIDE", "keep-out": "OUTSIDE", "timing": "ENDS", "order": "AFTER", "well-clear": "CLEAR",
    "progress": "SETTLED", "authority": "EPOCH", "link": "UP", "assumptions": "heartbeat-period",
}  # fmt: skip


def test_these_are_the_libraries() -> None:
    assert set(libraries()) == set(HOLDS) == set(BROKEN)
    guide = (Path(__file__).parents[2] / "docs" / "guides" / "requirements.md").read_text()
    for name in libraries():
        assert f"| `{name}` |" in guide
        assert library_text(name).startswith("# ")


@pytest.mark.parametrize("name", sorted(HOLDS))
def test_a_library_tells_what_it_is_about(name: str, tmp_path: Path) -> None:
    """The first sample holds, the second violates: by how much is next to the bound."""
    values, columns = HOLDS[name]
    spec = read(f'trace every 1 s\ninclude "{name}" as l with {values}\n', "t.req", tmp_path)
    names = [f"l.{column}" for column in columns]
    trace = tmp_path / "t.csv"
    rows = [",".join(str(values[k]) for values in columns.values()) for k in (0, 1)]
    trace.write_text(
        "\n".join([",".join(["time_s", *names]), *(f"{k},{row}" for k, row in enumerate(rows))])
        + "\n"
    )
    lines: list[str] = []
    watch(spec, trace, lines)
    asked = f"l.{BROKEN[name]}"
    assert f"{asked}:0,T" in lines, lines
    assert f"{asked}:1,F" in lines, lines
    assert not [line for line in lines if line.endswith(":0,F")], lines
    for one in spec.requirements:
        assert not isinstance(one.formula, NotRead)
        assert one.title
        assert one.source or name == "assumptions"


def test_all_libraries_hold_of_the_crossing(fly_once, root: Path, tmp_path: Path) -> None:
    """Every signal comes there, and every sample is decided."""
    flown = fly_once(root / "examples" / "crossing" / "mission.yaml")
    found = watch(
        spec_of(
            root / "examples" / "crossing", (root / "examples/crossing/guarantees.req").read_text()
        ),
        flown,
    )
    assert {one.verdict for one in found.outcomes} == {"holds"}, [
        vars(one) for one in found.outcomes
    ]
    assert {one.name.partition(".")[0] for one in found.outcomes} >= {
        "apart",
        "link_1",
        "box_1",
        "search",
    }
