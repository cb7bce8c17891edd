"""Costs as ratios within one run, with a history in `results/bench.json`.

Seconds depend on the machine and on what else runs there; what a sweep costs in units of another
calculation, timed beside it in the same process, hardly does. The other calculation is never ours,
so that a change of ours shows in the ratio, and it is of the same kind: what is bound by Python is
not held against a loop over a large array, which a neighbour on the machine slows differently (by
a third, at times).
"""

import json
import platform
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.integrate import solve_ivp
from scipy.special import ellipkinc

from analytic import (
    Beam,
    Case,
    Sweep,
    catenary,
    named_case,
    reconstruct,
    solve_contact,
    solve_sweep,
    solve_sweeps,
)
from mujoco_models import Settings, simulate_sweep
from tests.bench.timing import cpu_seconds

HISTORY = Path(__file__).parents[2] / "results" / "bench.json"
REGRESSION = 1.3
"""More than this over the last entry of the history is a regression.

Medians of seven pairs repeat within 10 % on a machine with other work to do.
"""

_PAIRS = 7
_ENOUGH = 0.5  # s, of the other calculation: longer says no more of it
_COUNT = 100_000  # contacts in an array
_ON_CONE = 2_000  # of a cone, of which a tenth is beyond the end of the solved curve
_BATCH = 82  # sweeps: as many as `solve_sweeps` takes at once


class Cost(NamedTuple):
    """A calculation of ours, and another one to hold it against."""

    ours: Callable[[], object]
    other: Callable[[], object]
    share: float = 1.0
    """What the ratio is of: one of so many sweeps, or stations."""


class Measured(NamedTuple):
    """The median of a ratio over some pairs, and half the width that holds half of them."""

    ratio: float
    spread: float


def costs() -> dict[str, Cost]:
    """What is timed, by the name that it has in the history."""
    profile, thin, case = catenary(0.5, -0.8), Beam(radius=0.0), named_case("catenary")
    tangent = np.deg2rad(np.linspace(-14, 30, _COUNT))
    tip = np.deg2rad(np.linspace(-31, -15, _COUNT))
    readings = solve_sweep(case)
    cone, cone_slopes = Beam(tip_radius=2.5e-4), np.deg2rad(np.linspace(-30, 40, _ON_CONE))
    amplitudes = np.linspace(0.1, 1.5, _COUNT)
    integrals = partial(ellipkinc, amplitudes, 0.3)

    def many() -> list[object]:
        return list(
            solve_sweeps(Case(profile=catenary(0.4 + 1e-3 * i, -0.8)) for i in range(_BATCH))
        )

    found = {
        "contacts in Phase A, by SciPy's elliptic integrals": Cost(
            lambda: solve_contact(profile, tip, thin), integrals
        ),
        "contacts in Phase B, by SciPy's elliptic integrals": Cost(
            lambda: solve_contact(profile, tangent, thin), integrals
        ),
        "contacts of a cone of 0.05, by SciPy's integration of a pendulum": Cost(
            lambda: solve_contact(profile, cone_slopes, cone), _pendulum
        ),
        "a sweep in closed form, by SciPy's integration of a pendulum": Cost(
            lambda: solve_sweep(replace(case)), _pendulum
        ),
        "one of many such sweeps, by the same": Cost(many, _pendulum, _BATCH),
        "the object from its readings, by the same": Cost(lambda: reconstruct(readings), _pendulum),
        "`vibrissa list cases`, by an import of SciPy's optimisers": Cost(
            partial(process, command("list", "cases")),
            partial(process, "import scipy.optimize"),
        ),
    }
    for segments in (40, 160):
        short = replace(case, sweep=Sweep(60))
        found[f"a station of MuJoCo's chain, N = {segments}, by an mj_forward of a chain"] = Cost(
            partial(simulate_sweep, short, Settings(segments=segments)),
            partial(_forward, *_chain(segments)),
            60,
        )
    return found


def measure(cost: Cost, pairs: int = _PAIRS) -> Measured:
    """A ratio of CPU times, in pairs one after the other."""
    first = cpu_seconds(cost.ours)  # which may import something
    ours = first if first > _ENOUGH else cpu_seconds(cost.ours)
    repeats = max(1, round(min(ours / 2, _ENOUGH) / max(cpu_seconds(cost.other), 1e-9)))
    found = []
    for _ in range(pairs):
        ours = cpu_seconds(cost.ours)
        other = min(cpu_seconds(partial(_repeat, cost.other, repeats)) for _ in range(2))
        found.append(ours / other * repeats / cost.share)
    quarter, half, three = statistics.quantiles(found, n=4)
    return Measured(half, (three - quarter) / 2)


def tried(cost: Cost) -> Measured:
    """The ratio of one pair, as it comes."""
    ratio = cpu_seconds(cost.ours) / max(cpu_seconds(cost.other), 1e-9) / cost.share
    return Measured(ratio, np.nan)


def last(path: Path = HISTORY) -> dict[str, float]:
    """The ratios of the last entry."""
    entry = json.loads(path.read_text())[-1]
    return {name: float(value["ratio"]) for name, value in entry["ratios"].items()}


def processor() -> str:
    """What it computes on: on another one Python may be faster and libraries not."""
    described = Path("/proc/cpuinfo")
    if not described.exists():
        return platform.processor() or platform.machine()
    lines = (line.partition(":") for line in described.read_text().splitlines())
    found = {name.strip(): value.strip() for name, _, value in reversed(list(lines))}
    return " ".join(
        found[name] for name in ("model name", "cpu family", "model", "stepping") if name in found
    )


def measured_on() -> str | None:
    """The processor of the last entry of the history."""
    found: str | None = json.loads(HISTORY.read_text())[-1].get("processor")
    return found


def regressions(now: Mapping[str, Measured], before: Mapping[str, float]) -> list[str]:
    """What has become dearer, a line each."""
    return [
        f"{name}: {now[name].ratio:.3g}, {now[name].ratio / ratio:.2f} times {ratio:.3g}"
        for name, ratio in before.items()
        if name in now and now[name].ratio > REGRESSION * ratio
    ]


def main(quick: bool) -> None:
    """Measure, show beside the last entry and, if not quick, add an entry to the history."""
    before = last()
    found = {name: (tried if quick else measure)(cost) for name, cost in costs().items()}
    table = Table("cost", "ratio", "spread", "last entry", title="Ratios of CPU times in one run")
    for name, (ratio, spread) in found.items():
        table.add_row(name, f"{ratio:.3g}", f"{spread:.1g}", f"{before.get(name, np.nan):.3g}")
    Console().print(table)
    for line in regressions(found, before):
        Console().print(f"dearer than in the last entry: {line}")
    if not quick:
        entry = {
            "date": datetime.now(UTC).date().isoformat(),
            "mujoco": mujoco.__version__,
            "numpy": np.__version__,
            "processor": processor(),
            "ratios": {
                name: {"ratio": float(f"{x.ratio:.4g}"), "spread": float(f"{x.spread:.2g}")}
                for name, x in found.items()
            },
        }
        history = [*json.loads(HISTORY.read_text()), entry]
        HISTORY.write_text(json.dumps(history, indent=1) + "\n")


def _repeat(call: Callable[[], object], times: int) -> None:
    for _ in range(times):
        call()


def command(*words: str) -> str:
    """The program that a command of ours is; a disagreement is no failure."""
    return f"""
import sys
from compare.commands.main import main
sys.argv[1:] = {words!r}
try:
    main()
except SystemExit as ended:
    assert ended.code != 2
"""


def process(program: str) -> None:
    """Run a program in a Python of its own, and in an empty folder."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-c", program], cwd=folder, check=True, capture_output=True)


def _pendulum() -> object:
    return solve_ivp(lambda _, y: [y[1], -np.sin(y[0])], (0.0, 10.0), [1.0, 0.0], rtol=1e-8)


def _chain(segments: int) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """A chain of capsules on hinges: nothing of it is ours."""
    spec = mujoco.MjSpec()
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    body, length = spec.worldbody, 1 / segments
    for i in range(segments):
        body = body.add_body(pos=[0, 0, length if i else 0])
        body.add_joint(type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 1, 0])
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=[0, 0, 0, 0, 0, length],
            size=[0.005, 0, 0],
            contype=0,
            conaffinity=0,
        )
    model = spec.compile()
    return model, mujoco.MjData(model)


def _forward(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    mujoco.mj_forward(model, data)
