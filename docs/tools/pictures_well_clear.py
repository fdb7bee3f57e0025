"""Draws `docs/img/well-clear-volumes.svg`: the horizontal volumes and the vertical one.

Every point is decided by the compiled kernels, with no formula of this script's own. The same input gives the same
file: `python docs/tools/pictures_well_clear.py`.
"""

from __future__ import annotations

import re
from io import StringIO
from pathlib import Path

import matplotlib as mpl
import numpy as np

from cratous.core.files.whole_file import write_atomically
from cratous.core.readings.machine.compiled import compiled
from cratous.core.well_clear import (
    horizontal_violation,
    horizontal_violation_tau,
    horizontal_violation_tcpa,
    horizontal_violation_tep,
    layer_violation,
)

mpl.use("svg")
from matplotlib import pyplot as plt

FILE = Path(__file__).resolve().parents[1] / "img" / "well-clear-volumes.svg"
DTHR_M, TTHR_S, CLOSING_M_S = 1222.32, 35.0, 80.0
ZTHR_M, TCOA_S, VMOD_S = 137.16, 20.0, 20.0
VOLUMES = (
    ("tep", horizontal_violation_tep, "#9ecae1"),
    ("tau_mod", horizontal_violation, "#4292c6"),
    ("tcpa", horizontal_violation_tcpa, "#08519c"),
    ("plain tau", horizontal_violation_tau, "#fdae6b"),
)
STEPS = 121


def horizontal(axes: plt.Axes) -> None:
    """Positions of a stationary intruder around the ownship, which flies to the right."""
    x, y = np.meshgrid(np.linspace(-1600, 5000, STEPS), np.linspace(-1600, 1600, STEPS))
    for name, kernel, colour in VOLUMES:
        # the relative position is ownship minus intruder
        inside = compiled(kernel)(-x, -y, CLOSING_M_S, 0.0, DTHR_M, TTHR_S)
        axes.contour(x, y, inside.astype(float), [0.5], colors=[colour], linewidths=1.5)
        axes.plot([], [], color=colour, label=name)
    axes.plot([0], [0], marker=">", color="black", linestyle="")
    axes.set_aspect("equal")
    axes.set_title("Horizontal: intruders that violate", fontsize=9)
    axes.set_xlabel("ahead [m]", fontsize=8)
    axes.set_ylabel("aside [m]", fontsize=8)
    axes.legend(fontsize=7, loc="upper right")


def vertical(axes: plt.Axes) -> None:
    """Relative altitude against relative climb rate."""
    rate, height = np.meshgrid(np.linspace(-15, 15, STEPS), np.linspace(-500, 500, STEPS))
    for name, tcoa, vmod, colour in (
        ("TCOA 20 s", TCOA_S, 0.0, "#4292c6"),
        ("VMOD 20 s", 0.0, VMOD_S, "#fdae6b"),
        ("ZTHR alone", 0.0, 0.0, "#555555"),
    ):
        inside = compiled(layer_violation)(height, rate, ZTHR_M, tcoa, vmod)
        axes.contour(rate, height, inside.astype(float), [0.5], colors=[colour], linewidths=1.5)
        axes.plot([], [], color=colour, label=name)
    axes.set_title("Vertical: states that violate", fontsize=9)
    axes.set_xlabel("relative climb rate [m/s]", fontsize=8)
    axes.set_ylabel("relative altitude [m]", fontsize=8)
    axes.legend(fontsize=7, loc="upper right")


def over_time(axes: plt.Axes) -> None:
    """A counterexample: when each volume is violated in one straight flight."""
    t = np.linspace(0, 40, 401)
    for row, (name, kernel, colour) in enumerate(VOLUMES):
        lost = compiled(kernel)(600 - 20 * t, 140.0, -20.0, 0.0, 150.0, 16.0)
        axes.fill_between(t, row, row + 0.8, where=lost, color=colour, linewidth=0)
        axes.text(0.3, row + 0.25, name, fontsize=8)
    axes.set_yticks([])
    axes.set_xlim(0, 40)
    axes.set_title("Plain tau: lost, clear, lost again", fontsize=9)
    axes.set_xlabel("time [s]", fontsize=8)


def main() -> int:
    """Draw and write the picture."""
    plt.rcParams.update(
        {"svg.hashsalt": "cratous", "svg.fonttype": "none", "path.simplify_threshold": 1.0}
    )
    figure, (a, b, c) = plt.subplots(1, 3, figsize=(12, 3.4), width_ratios=(2, 1.2, 1.4))
    horizontal(a)
    vertical(b)
    over_time(c)
    for axes in (a, b, c):
        axes.tick_params(labelsize=7)
    figure.tight_layout()
    drawn = StringIO()
    figure.savefig(drawn, format="svg", metadata={"Date": None})
    # a tenth of a point is not visible, and makes the file a third as large
    text = re.sub(r"(\d\.\d)\d+", r"\1", drawn.getvalue())
    write_atomically(FILE, "\n".join(line.rstrip() for line in text.splitlines()) + "\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
