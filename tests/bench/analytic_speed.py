"""The closed forms against the paper's shooting and collocation, whole sweeps, and a command."""

from collections.abc import Callable
from functools import partial

import numpy as np
from rich.console import Console
from rich.table import Table

from analytic import Beam, Case, catenary, named_case, solve_contact, solve_sweep, solve_sweeps
from analytic.checks import boundary_value_problem, tip_angle_by_shooting
from tests.bench.ratios import command, process
from tests.bench.timing import cpu_seconds, least_seconds

THIN = Beam(radius=0.0)
CONTACTS, BATCH = 100_000, 82


def main(quick: bool) -> None:
    """Print what a contact, a sweep and a run take."""
    timed = cpu_seconds if quick else least_seconds
    many = CONTACTS // 100 if quick else CONTACTS
    case, profile = named_case("catenary"), catenary(0.5, -0.8)
    slopes = {"A": np.linspace(-31, -15, many), "B": np.linspace(-14, 30, many)}
    tip, low = (solve_contact(profile, [np.deg2rad(x)], THIN).iloc[0] for x in (-24, 0))
    seconds = {
        f"a contact in Phase {phase}, in an array": timed(
            partial(solve_contact, profile, np.deg2rad(degrees), THIN)
        )
        / many
        for phase, degrees in slopes.items()
    }
    family = [Case(profile=catenary(0.4 + 1e-3 * i, -0.8)) for i in range(BATCH)]
    short = ("--stations", "12", "--segments", "10") if quick else ()
    calls: dict[str, Callable[[], object]] = {
        "in Phase A, by the paper's shooting (1e-12)": partial(
            tip_angle_by_shooting, tip["contact_angle"], tip["contact_y"]
        ),
        "in Phase A, by solve_bvp (1e-10)": partial(
            boundary_value_problem, tip["contact_angle"], tip["contact_y"], False
        ),
        "in Phase B, by solve_bvp (1e-10)": partial(
            boundary_value_problem, 0.0, low["contact_y"], True
        ),
        "a sweep of 200 stations": partial(solve_sweep, case),
        f"{BATCH} such sweeps at once": lambda: list(solve_sweeps(family)),
        "`vibrissa run catenary`": partial(process, command("run", "catenary", *short)),
        "Python and its imports": partial(process, "import mujoco, pandas, matplotlib.pyplot"),
    }
    seconds |= {name: timed(call) for name, call in calls.items()}
    table = Table("closed form", "CPU ms")
    for name, took in seconds.items():
        table.add_row(name, f"{1e3 * took:.3g}")
    Console().print(table)
