"""Flies and judges one run of a campaign in a persistent process."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from functools import cache
from math import degrees
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from cratous.services.cli.job import Settings, fly_mission
from cratous.spec.errors import BadInput, CratousError, NoPlan, Refused
from cratous.spec.mission.guarantees import Outcome

FUNCTION = f"{__name__}:fly_run"
FLOWN, NO_PLAN, IMPOSSIBLE, FAILED = "flown", "no plan", "impossible", "failed"


def fly_run(task: dict[str, Any]) -> dict[str, Any]:
    """The result of a run, as plain data determined by `task` alone.

    task: `decides` of a run (mission, seed, daa, allow_unproved, judge, model, own), and `keep`:
    folder for its results, None if only the result is wanted.
    """
    keep = task.get("keep")

    def flown(file: Path, task: dict[str, Any]) -> dict[str, Any]:
        return _flown(file, task, file.parent if keep is None else Path(keep))

    return result_of_file(task, flown)


def result_of_file(
    task: dict[str, Any], fly: Callable[[Path, dict[str, Any]], dict[str, Any]]
) -> dict[str, Any]:
    """The result of flying a task's mission from a file in a temporary folder; errors are results too."""
    with TemporaryDirectory(prefix="cratous-") as scratch:
        file = Path(scratch) / "mission.yaml"
        file.write_text(task["mission"], encoding="utf-8")
        try:
            return fly(file, task)
        except NoPlan as error:
            return {"kind": NO_PLAN, "why": list(error.reasons)}
        except Refused as error:
            return {"kind": "refused", "why": [str(error)]}
        except CratousError as error:
            return {"kind": IMPOSSIBLE, "why": [_plain(error, file)]}
        except (MemoryError, OSError):
            raise  # an error of the machine, not of the mission
        except Exception as error:  # a defect is a result too: it follows from the run
            return {"kind": FAILED, "why": [f"{type(error).__name__}: {error}"[:500]]}


def _plain(error: CratousError, file: Path) -> str:
    return str(error).replace(str(file), file.name)


@cache
def standing(allow_unproved: bool) -> Any:
    """The ledger's standing, evaluated once per process: loaded code does not change."""
    from cratous.core import ledger

    return ledger.require(allow_unproved=allow_unproved)


def _flown(file: Path, task: dict[str, Any], out: Path) -> dict[str, Any]:
    from cratous.services.loading import load
    from cratous.services.requirements.requirement_files import files_of

    mission = load(file, task["seed"])
    proofs = standing(task["allow_unproved"])
    own = files_of(task["own"])
    settings = Settings(task["daa"], task["allow_unproved"], command(task), own)
    if task.get("keep") is not None:
        from cratous.services.certify.report import write_report
        from cratous.services.results.folder import results_folder

        with results_folder(out) as folder:
            report = fly_mission(mission, folder, settings, proofs)
            write_report(report, folder)
            return _result(mission, report, folder, task)
    report = fly_mission(mission, out, settings, proofs)
    return _result(mission, report, out, task)


def command(task: dict[str, Any]) -> str:
    """The command that flies only this run, once its mission is a file."""
    parts = ["cratous", "run", "mission.yaml"]
    parts += ["--seed", str(task["seed"])] if task["seed"] else []
    parts += ["--no-daa"] * (not task["daa"]) + ["--allow-unproved"] * task["allow_unproved"]
    for own in task["own"]:
        parts += ["--requirements", own["file"]]
    return shlex.join(parts)


def _result(
    mission: Any, report: dict[str, Any], folder: Path, task: dict[str, Any]
) -> dict[str, Any]:
    from cratous.services.certify.charts import separation_view
    from cratous.services.certify.requirement_views import own_constraints

    view = separation_view(report)
    return {
        "kind": FLOWN,
        "proved": not report["proofs"]["problems"],
        "requirements": {
            row["requirement"]: _requirement(row)
            for row in (*report["requirements"], *own_constraints(report))
        },
        "takeovers": len(report["flight"]["takeovers"]),
        "outcome": report["flight"]["outcome"],
        "end_ms": report["flight"]["end_ms"],
        "separation_m": None if view is None else min(c["least_m"] for c in view["curves"]),
        "log": report["log"]["digest"],
        "mission_hash": report["mission_hash"],
        "drawn": _drawn(mission) if task["seed"] else {},
        "judge": _judged(report, folder) if task["judge"] else None,
        "model": _modelled(mission, folder, task["daa"]) if task["model"] else None,
    }


def _requirement(row: dict[str, Any]) -> dict[str, Any]:
    found = {key: row[key] for key in ("verdict", "margin", "unit", "time_ms", "item")}
    if row["verdict"] != Outcome.HOLDS:
        found["note"] = row["note"]
    if (until_ms := row.get("own", {}).get("until_ms")) is not None:
        found["until_ms"] = until_ms
    return found


def _drawn(mission: Any) -> dict[str, float]:
    """Values drawn by the mission's own variants: courses and speeds."""
    found = {}
    for vehicle in mission.vehicles[:4]:
        course = degrees(vehicle.heading_rad) % 360
        found[f"vehicle {vehicle.id} course_deg"] = round(course, 3)
        found[f"vehicle {vehicle.id} speed_m_s"] = round(vehicle.speed_m_s, 3)
    return found


def replayed(mission: Any, avoidance: bool, envelopes: Any) -> Any:
    """The events of a log as steps of the proved system; the only access to it."""
    from cratous.services.system_model.replay import replay

    return replay(mission, avoidance, envelopes)


def _modelled(mission: Any, folder: Path, avoidance: bool) -> dict[str, Any]:
    """Whether each authority event in the log is a step of the proved system; fits None: no ICAROUS instance."""
    from cratous.services.logs.log import read_envelopes
    from cratous.services.results.names import LOG_NAME

    found = replayed(mission, avoidance, read_envelopes(folder / LOG_NAME))
    misfit = found.finding
    return {
        "fits": misfit is None if found.vehicles else None,
        "events": found.events.total(),
        "why": "" if misfit is None else misfit.text,
    }


def _judged(report: dict[str, Any], folder: Path) -> dict[str, Any]:
    """The judge's verdicts on the log, compared with the report that contains the monitor's verdicts."""
    from cratous.services.certify.report import report_text
    from cratous.services.cli.judge import judgement
    from cratous.services.results.names import REPORT_NAME

    file = folder / REPORT_NAME
    if not file.exists():
        file.write_text(report_text(report), encoding="utf-8")
    try:
        found = judgement(folder).data()
    except BadInput as error:
        return {"refused": error.what}
    return {
        "verdict": found["verdict"],
        "guarantees": found["guarantees"],
        "disagreements": [
            {key: d[key] for key in ("guarantee", "item", "judge", "monitor", "note")}
            for d in found["differences"]
            if d["kind"] == "disagree"
        ],
        "differences": len(found["differences"]),
        "rows": len(found["rows"]),
    }
