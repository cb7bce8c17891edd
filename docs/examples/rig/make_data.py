"""Makes ``data/``: what a rig with every common flaw would write, of a truth that is known.

A vibrissa of 50 mm is swept to the left past a cylinder, four times on two days. The truth is the
closed form; the flaws are put on it here, and `PLANTED` counts them.
"""

from pathlib import Path

import numpy as np

from analytic import Beam, Case, Sweep, circle, solve_sweep

VIBRISSA = Beam(0.05, 2e-6, 0.25e-3, si=True)  # m, N m^2, m
OBJECT = circle(0.04, lowest=(0.0, 0.02))
FILES = {"monday.csv": 2, "tuesday.csv": 2}
"""Passes in each file."""
NOISE = 1e-3  # of each reading's largest magnitude
LAG = 0.1e-3  # m; the second pass of a day lags behind the first by the stage's play
GAINS = {"Fx": 1.02, "Fy": 0.97, "Mz": 1.0}  # what the sensor reads is too small by that
ZEROS = {"Fx": 1.7, "Fy": -0.9, "Mz": 12.0}  # mN, mN, mN mm
DRIFTS = {"Fx": 0.02, "Fy": -0.03, "Mz": 0.05}  # over a pass, of the largest magnitude
SCALES = {"Fx": 1e-3, "Fy": 1e-3, "Mz": 1e-6}
READINGS = {"Fx": "force_x", "Fy": "force_y", "Mz": "moment_z"}
PLANTED = {"without_foot_x": 2, "missing": 6, "dropped": 4, "averaged": 3}
"""Rows that are not to be used, in each pass."""
SWAPPED = 8
"""Neighbouring rows in each pass that stand in the wrong order."""


def truth() -> Case:
    """The case of which the data are."""
    return Case(VIBRISSA, OBJECT, Sweep(200), "cylinder")


def one_pass(rng: np.random.Generator, second: bool) -> list[list[str]]:
    """The rows of a pass as the rig writes them."""
    case = truth()
    # Uneven stations, 6 mm of free way before the object and behind it, and a gap in the middle.
    first, last = case.foot_x[[0, -1]]
    foot_x = np.sort(rng.uniform(last - 6e-3, first + 6e-3, 420))[::-1]
    foot_x = foot_x[~((foot_x > -4e-3) & (foot_x < -1e-3))]
    dense = solve_sweep(
        Case(VIBRISSA, OBJECT, Sweep(20_000, first + 6e-3, last - 6e-3), "cylinder")
    )
    along = (foot_x - foot_x[0]) / (foot_x[-1] - foot_x[0])
    cells = {"stage": 1e3 * (foot_x + (LAG if second else 0.0))}
    for column, name in READINGS.items():
        exact = np.interp(foot_x[::-1], dense.values("foot_x")[::-1], dense.values(name)[::-1])
        exact = exact[::-1] / SCALES[column] / GAINS[column]
        size = np.abs(exact).max()
        drift = DRIFTS[column] * size * along
        noise = NOISE * size * rng.standard_normal(len(foot_x))
        cells[column] = exact + drift + noise + ZEROS[column]
    rows = [[f"{x:.4f}" for x in row] for row in np.transpose([*cells.values()])]
    inside = rng.permutation(np.arange(60, len(rows) - 60, 3))
    kinds = iter(np.split(inside, np.cumsum([*PLANTED.values(), SWAPPED])))
    for i in next(kinds):
        rows[i][0] = ""  # the stage's reading was lost
    for i in next(kinds):
        rows[i][1] = "OVL"  # the amplifier's word for overload
    for i in next(kinds):
        rows[i][1:] = ["0.0000"] * 3  # a dropout
    for i in (repeated := next(kinds)):
        rows[i + 1][0] = rows[i][0]  # the stage stood still
    for i in next(kinds):
        rows[i], rows[i + 1] = rows[i + 1], rows[i]
    assert len(repeated) == PLANTED["averaged"]
    return rows


def write(folder: Path, seed: int = 0) -> None:
    """Write the files; the same seed makes the same."""
    rng = np.random.default_rng(seed)
    folder.mkdir(parents=True, exist_ok=True)
    for name, passes in FILES.items():
        lines = ["pass;stage;Fx;Fy;Mz", ";mm;mN;mN;mN mm"]
        for number in range(passes):
            lines += [";".join([str(number + 1), *row]) for row in one_pass(rng, number > 0)]
        (folder / name).write_text("\n".join(lines).replace(".", ",") + "\n", encoding="utf-8")


if __name__ == "__main__":
    write(Path(__file__).parent / "data")
