"""How slow is quasi-static, and what do MuJoCo's settings cost? One setting at a time.

``python -m docs.figures.quasi_static FILE.csv`` sweeps the catenary in motion, in about four
minutes of CPU time, and writes a row a sweep; `docs.figures.quasi_static_picture` draws them.
"""

import math
import sys
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd

from analytic import Sweep, named_case, solve_sweep
from analytic.problem.files import write_whole
from compare.comparison import compare
from compare.measure.disagreement import Disagreement
from compare.simulate.workers import Workers, available_cores
from mujoco_models.errors import DivergedError
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings

_BASE = Motion(speed=0.1, timestep=0.02, damping_ratio=0.05, contact_stiffness=1e4)
_SETTINGS = Settings(segments=40, contour_points=800)
_STATIONS = 100
# MuJoCo's default contact: a time constant of 20 ms, of a wire whose first period is 28 ms.
STOCK = replace(_BASE, contact_stiffness=None, solref=(20 / 28, 1.0), solimp=0.9)
_RUBBING = replace(
    _BASE, timestep=0.002, contact_stiffness=1e3, damping_ratio=0.2, friction=0.2
)  # as stiff as friction allows with such a step

_ALONE: dict[str, tuple[Any, ...]] = {
    "speed": (0.02, 0.04, 0.1, 0.2, 0.4, 1.0),
    "timestep": (0.005, 0.01, 0.02, 0.04),
    "damping_ratio": (0.0, 0.01, 0.05, 0.2, 0.5, 2.0),
    "contact_stiffness": (1e3, 1e4, 1e5, 1e6),
    "solver": ("newton", "cg", "pgs"),
}
"""Settings of a motion, each varied on its own."""


def variants() -> Iterator[tuple[str, str, Motion, Settings]]:
    """All sweeps of the page."""
    for name, values in _ALONE.items():
        for value in values:
            one = replace(_BASE, **{name: value})
            if name == "timestep":
                one = replace(one, contact_stiffness=4 / value**2)
            yield name, f"{value}", one, _SETTINGS
    for speed in _ALONE["speed"]:
        damped = replace(_BASE, speed=speed, damping_ratio=0.5)
        yield "speed, damping ratio 0.5", f"{speed}", damped, _SETTINGS
    for segments in (10, 20, 40, 80):
        yield "segments", f"{segments}", _BASE, replace(_SETTINGS, segments=segments)
    yield "clamp", "naive", _BASE, replace(_SETTINGS, clamp="naive")
    yield "solref, solimp", "0.71, 0.9", STOCK, _SETTINGS
    for time_constant, solimp in (
        (0.14, 0.9),
        (0.14, 0.99),
        (0.04, 0.9),
        (0.04, 0.99),
    ):
        one = replace(STOCK, solref=(time_constant, 1.0), solimp=solimp)
        yield "solref, solimp", f"{time_constant:.2g}, {solimp}", one, _SETTINGS
    for integrator in ("discrete", "implicitfast", "implicit", "euler", "rk4"):
        heavy = replace(_BASE, integrator=integrator, armature=1.0, contact_stiffness=2.5e3)
        yield "integrator, armature 1", integrator, heavy, _SETTINGS
    for cone in ("elliptic", "pyramidal"):
        yield "cone, friction 0.2", cone, replace(_RUBBING, cone=cone), _SETTINGS


def measure(name: str, value: str, motion: Motion, settings: Settings) -> dict[str, Any]:
    """One sweep in motion against the closed form."""
    from mujoco_models import simulate_motion  # MuJoCo is imported only where it is used

    case = replace(named_case("catenary"), sweep=Sweep(_STATIONS), friction=motion.friction or 0.0)
    row = {"setting": name, "value": value}
    try:
        moved = simulate_motion(case, motion, settings)
    except DivergedError:
        return row
    exact = solve_sweep(case)
    found = compare(exact, moved)
    shift = found.snap_off.difference
    return row | {
        "tip": _worst(found.disagreement, "tip"),
        "tangent": _worst(found.disagreement, "tangent"),
        "late": math.nan if shift is None else -shift,
        "chattering": int((moved.table["status"] != "ok").sum()),
        "seconds": moved.provenance["seconds"],
    }


def _worst(found: Mapping[str, Disagreement], phase: str) -> float:
    return max((d.rms_by_phase.get(phase, math.nan) for d in found.values()), default=math.nan)


def main(path: Path) -> None:
    """Sweep all variants, on all cores, and write them down."""
    with Workers(available_cores()) as pool:
        started = [pool.submit(measure, *variant) for variant in variants()]
        rows = [one.result() for one in started]
    table = pd.DataFrame(rows).astype({"chattering": "Int64"})
    write_whole(path, table.to_csv(index=False, float_format="%.4g"))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
