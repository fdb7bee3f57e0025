"""Configurations, encounter files, and the command `cratous daa`."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from cratous.services import cli
from cratous.services.cli.daa import daa
from cratous.services.daa import run
from cratous.spec.daa import conf_files as daa_conf
from cratous.spec.daa import encounter_files as daa_file
from cratous.spec.daa.parameters import FOOT, KEYS, KNOT, MID, NMI, TCAS, Parameters
from cratous.spec.daa.presets import named_or_file, names, preset
from cratous.spec.errors import BadInput

HEADER = "NAME lat lon alt trk gs vs time\nunitless [deg] [deg] [ft] [deg] [knot] [fpm] [s]\n"
ROWS = "own 33.8 -117.0 5000 0 150 0 0\nintr 34.0 -117.0 5000 180 180 0 0\n"


def refusal(text: str, line: int, item: str) -> BadInput:
    """Why a configuration is refused, at this line and key."""
    with pytest.raises(BadInput) as caught:
        daa_conf.parse(text, "c")
    assert caught.value.where == f"c:{line}"
    assert caught.value.item == item
    return caught.value


@pytest.mark.parametrize("name", names())
def test_presets_are_read_and_written_without_loss(name: str):
    made = preset(name)
    again = daa_conf.parse(daa_conf.write(made))
    assert again.parameters == made.parameters
    assert made.parameters.alerters


def test_do_365_says_what_the_standard_says():
    p = preset("do_365b").parameters
    first = p.alerters[0].levels
    assert [x.alerting_time_s for x in first] == [55, 55, 25]
    assert [x.volume.zthr_m for x in first] == pytest.approx([700 * FOOT, 450 * FOOT, 450 * FOOT])
    assert first[1].volume.dthr_m == pytest.approx(0.66 * NMI)
    assert first[1].volume.tthr_s == 35
    assert p.alerters[1].levels[0].volume.dthr_m == pytest.approx(1500 * FOOT)
    assert p.alerters[2].levels[0].volume.dthr_m == pytest.approx(2200 * FOOT)
    assert p.corrective_region == MID
    assert not p.ownship_centric_alerting


def test_units_old_names_and_defaults():
    made = daa_conf.parse(
        "max_gs = 100 [knot]\nmin_hs = 5 # SI\ntrk_step = 2 deg\nalerting_n = 4\n"
    )
    p = made.parameters
    assert p.max_hs_m_s == pytest.approx(100 * KNOT)
    assert p.min_hs_m_s == 5
    assert made.units["step_hdir"] == "deg"
    assert "step_hdir = 2.0 [deg]" in daa_conf.write(made)
    assert p.lookahead_time_s == Parameters().lookahead_time_s
    assert len(KEYS) > 60


@pytest.mark.parametrize(
    ("text", "line", "item", "says"),
    [
        ("lookahead = 3\n", 1, "lookahead", "a key of the configuration"),
        ("\nmax_hs = 100 [ft]\n", 2, "max_hs", "knot"),
        ("max_hs = fast\n", 1, "max_hs", "a finite number"),
        ("ca_bands = yes\n", 1, "ca_bands", "true or false"),
        ("step_hs = 0 [knot]\n", 1, "step_hs", "at least"),
        ("left_hdir = 200 [deg]\n", 1, "left_hdir", "0 to 180 deg"),
        ("step_hs\n", 1, "", "key = value"),
        ("step_hs = 1\ngs_step = 2\n", 2, "step_hs", ""),
        ("alerting_m = 1.5\n", 1, "alerting_m", ""),
        ("corrective_region = WEST\n", 1, "corrective_region", "far or mid or near"),
        ("alerters = A\n", 1, "A", "A_alert_1_detector"),
        ("alerters = A\nA_alert_1_detector = d\n", 2, "A_alert_1_detector", "A_load_core_detection_d"),
        ("lookahead_tme = 60 [s]", 1, "lookahead_tme", "such as lookahead_time"),
        ("\nleft_hdir = 200 [deg]", 2, "left_hdir", "expected 0 to 180 deg; got 200 [deg]"),
        ("min_hs = 60 [ft]", 1, "min_hs", "expected m/s or mps"),
        ("turn_rate = 3 [deg/s]\n\nbank_angle = 20 [deg]", 3, "bank_angle", "not both"),
        ("\nurgency_strategy = nearest", 2, "urgency_strategy", "none or fixed or dcpa"),
        ("\nmost_urgent_aircraft = A", 2, "most_urgent_aircraft", "got A with none"),
        ("turn_rate = 3\nturn_rate = 4", 2, "turn_rate", "expected one line; got another in c:1"),
    ],
)  # fmt: skip
def test_errors_of_configurations_name_line_key_and_what_was_expected(text, line, item, says):
    assert says in str(refusal(text, line, item))


@pytest.mark.parametrize(
    ("text", "item"),
    [
        ("min_hs = 10\nmax_hs = 9\n", "min_hs_m_s"),
        ("turn_rate = 0.1\nbank_angle = 0.1\n", "bank_angle"),
        ("alerting_m = 3\nalerting_n = 2\n", "alerting_m"),
    ],
)
def test_values_that_do_not_fit_together_are_refused(text, item):
    with pytest.raises(BadInput) as error:
        daa_conf.parse(text, "my.conf")
    assert error.value.item == item


def test_an_unknown_preset_is_a_file_that_is_not_there():
    with pytest.raises(BadInput, match="no such file"):
        named_or_file("do_366")


# -- encounter files -----------------------------------------------------------------------
def test_columns_in_any_order_units_and_settings():
    text = (
        "# comment\nstep_hs = 2 [knot]\n"
        "time, aircraft, sx, sy, sz, vx, vy, vz, alerter\n"
        "[s], -, [m], [m], [m], [m/s], [m/s], [m/s], -\n"
        "0,own,0,0,1000,0,100,0,1\n0,i,0,9000,1000,0,-100,0,2\n1,own,0,100,1000,0,100,0,1\n"
    )
    made = daa_file.parse(text)
    assert made.settings == {"step_hs_m_s": 2 * KNOT}
    assert [len(rows) for _, rows in made.steps] == [2, 1]
    assert made.steps[0][1][1].values["y"] == 9000
    assert daa_file.parse(text, ownship="i").steps[0][1][0].id == "i"
    assert daa_file.parse(text, ownship="i").left_out


def test_units_by_default():
    text = "name lat lon alt trk gs vs time\nown 10 20 1000 90 100 60 0\n"
    values = daa_file.parse(text).steps[0][1][0].values
    assert values["alt"] == pytest.approx(1000 * FOOT)
    assert values["vx"] == pytest.approx(100 * KNOT)
    assert values["vs"] == pytest.approx(FOOT)


@pytest.mark.parametrize(
    ("text", "line", "item", "got"),
    [
        (HEADER.replace("trk", "course") + ROWS, 1, "course", "course"),
        (HEADER.replace("vs", "lat") + ROWS, 1, "lat", ""),
        (HEADER.replace("lat", "sx") + ROWS, 1, "", "NAME, sx"),
        (HEADER.replace("[knot]", "[ft]") + ROWS, 2, "gs", "ft"),
        (HEADER + ROWS + "own 33.8 -117 5000 0 150 0\n", 5, "", "7"),
        (HEADER + ROWS + "own 33.8 -117 5000 0 150 0 0\n", 5, "time of own", "0 s"),
        (HEADER + "own 33.8 -117 high 0 150 0 0\n", 3, "alt", "high"),
        (HEADER + "own 91 -117 1 0 150 0 0\n", 3, "lat", "91 deg"),
        (HEADER + "own 9 -117 1 0 -150 0 0\n", 3, "gs", "-77"),
        (HEADER + "own 9 -117 1 0 nan 0 0\n", 3, "gs", "nan"),
    ],
)
def test_errors_of_encounter_files_name_line_column_and_what_was_got(text, line, item, got):
    with pytest.raises(BadInput) as error:
        daa_file.parse(text, "my.daa")
    assert error.value.where == f"my.daa:{line}"
    assert error.value.item == item
    assert error.value.got.startswith(got)


def test_wind_is_taken_from_heading_and_airspeed(tmp_path: Path):
    file = tmp_path / "wind.daa"
    head = HEADER.replace("time", "time heading airspeed").replace("[s]", "[s] [deg] [knot]")
    file.write_text(head + "own 33 -117 5000 0 150 0 0 0 100\nintr 34 -117 5000 180 180 0 0 0 0\n")
    step = next(run(file, preset("do_365b").parameters))
    assert step.wind_m_s == pytest.approx((0.0, 50 * KNOT))
    assert step.instant.own.vn_m_s == pytest.approx(100 * KNOT)


# -- the command ---------------------------------------------------------------------------
@pytest.fixture
def encounter(root: Path) -> str:
    return str(root / "examples" / "encounters" / "two_intruders.daa")


def test_tables(encounter: str, tmp_path: Path):
    for kind, columns in (("alerts", "level"), ("metrics", "dcpa_m"), ("bands", "region")):
        done = CliRunner().invoke(daa, [kind, encounter], standalone_mode=False)
        assert done.exception is None
        rows = list(csv.DictReader(io.StringIO(done.output)))
        assert columns in rows[0]
        assert len(rows) >= 122
    out = tmp_path / "alerts.json"
    CliRunner().invoke(daa, ["alerts", encounter, "--json", "-o", str(out)], standalone_mode=False)
    rows = json.loads(out.read_text())
    assert max(row["level"] for row in rows) == 3


def test_explanation_names_intruder_volume_time_and_what_was_refused(encounter: str):
    done = CliRunner().invoke(daa, ["explain", encounter, "--time", "60"], standalone_mode=False)
    text = done.output
    assert "alert north: level 3 of DWC_Phase_I (NEAR)" in text
    assert "hdir: edge at" in text
    assert "volume is violated" in text
    assert "chosen" in text
    assert "refused" in text


@pytest.mark.parametrize("suffix", [".svg", ".png"])
def test_pictures(encounter: str, tmp_path: Path, suffix: str):
    file = tmp_path / f"picture{suffix}"
    done = CliRunner().invoke(daa, ["plot", encounter, "-o", str(file)], standalone_mode=False)
    assert done.exception is None
    assert file.stat().st_size > 20_000


def test_bad_input_ends_with_2(encounter: str, tmp_path: Path, capsys):
    assert cli.main(["daa", "alerts", encounter, "--config", "nothing.conf"]) == 2
    assert "no such file" in capsys.readouterr().err
    assert cli.main(["daa", "plot", encounter, "-o", str(tmp_path / "a.jpg")]) == 2
    assert cli.main(["daa", "explain", encounter, "--time", "7000"]) == 2
    assert cli.main(["daa", "presets"]) == 0
    assert "small_uas" in capsys.readouterr().out


TCAS_CONF = """
alerters = A
A_alert_1_region = NEAR
A_alert_1_alerting_time = 0 [s]
A_alert_1_early_alerting_time = 0 [s]
A_alert_1_detector = det_1
A_load_core_detection_det_1 = gov.nasa.larcfm.ACCoRD.TCAS3D
A_det_1_TCAS_HMDFilter = true
A_det_1_TCAS_level_3 = 2350.0 [ft]
A_det_1_TCAS_TAU_3 = 15.0 [s]
A_det_1_TCAS_TCOA_8 = 35.0 [s]
A_det_1_TCAS_DMOD_5 = 0.55 [nmi]
A_det_1_TCAS_ZTHR_7 = 700.0 [ft]
A_det_1_TCAS_HMD_4 = 2126.0 [ft]
A_det_1_TCAS_TAU_1 = 0.0 [s]
"""


def test_the_table_of_resolution_advisories_may_be_written_out() -> None:
    (alerter,) = daa_conf.parse(TCAS_CONF).parameters.alerters
    assert alerter.levels[0].volume.kind == TCAS


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("A_det_1_TCAS_TAU_4 = 30.0 [s]", "20 s"),
        ("A_det_1_TCAS_ZTHR_2 = 850.0 [ft]", "0 m"),
        ("A_det_1_TCAS_level_7 = 40000.0 [ft]", "12801.6 m"),
        ("A_det_1_TCAS_HMDFilter = false", "true"),
        ("A_det_1_TCAS_TAU_9 = 30.0 [s]", "a key of the configuration"),
    ],
)
def test_another_tcas_table_is_refused_and_never_read_as_this_one(line: str, expected: str) -> None:
    key = line.split(" = ")[0]
    text = "\n".join(x for x in TCAS_CONF.splitlines() if not x.startswith(f"{key} ")) + f"\n{line}"
    with pytest.raises(BadInput) as error:
        daa_conf.parse(text, "some.conf")
    assert (error.value.item, error.value.expected) == (key, expected)
    assert "some.conf" in error.value.where


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("[ft]", "[fathom]", "e.daa:3: alt: an unknown unit; expected s or ms"),
        ("vs time", "vs tyme", "e.daa:2: tyme: an unknown column"),
        ("vs time", "vs time dta_alerter", "dta_alerter: values do not fit together"),
    ],
)
def test_an_encounter_error_says_what_is_wrong(
    tmp_path: Path, root: Path, old: str, new: str, says: str
):
    from cratous.services.daa import named_or_file, run

    text = (root / "examples/encounters/two_intruders.daa").read_text()
    lines = text.replace(old, new).splitlines()
    if "dta_alerter" in new:
        lines = [
            *lines[:2],
            lines[2] + " unitless",
            *(line + " 99" if line.strip() else line for line in lines[3:]),
        ]
    file = tmp_path / "e.daa"
    file.write_text("\n".join(lines) + "\n")
    with pytest.raises(BadInput) as caught:
        list(run(file, named_or_file("do_365b").parameters))
    assert says in str(caught.value)
