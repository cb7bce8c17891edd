"""The closed forms against the paper's shooting and collocation, and their memory."""

import time
import tracemalloc
from collections.abc import Iterator

import numpy as np
from rich.console import Console
from rich.table import Table

from analytic import (
    Beam,
    Case,
    Readings,
    catenary,
    circle,
    find_events,
    named_case,
    solve_contact,
    solve_sweep,
    solve_sweeps,
)
from analytic.checks import boundary_value_problem, tip_angle_by_shooting
from tests.bench.timing import seconds

THIN = Beam(radius=0.0)
COUNT = 100_000


def varied(count: int) -> Iterator[Case]:
    """Vibrissae past catenaries and circles, none like another.

    Parameters
    ----------
    count : int
        How many.

    Yields
    ------
    Case
        Of 200 stations.
    """
    numbers = np.random.default_rng(0)
    for i in range(count):
        width, size, radius = numbers.uniform((0.3, 0.7, 1e-3), (0.8, 2.0, 1e-2))
        profile = circle(size, (0.0, 0.4)) if i % 2 else catenary(width, -0.8)
        yield Case(Beam(radius=radius), profile)


def main(quick: bool) -> None:
    many = COUNT // 100 if quick else COUNT
    profile = catenary(0.5, -0.8)
    tangent = np.deg2rad(np.linspace(-14, 30, many))
    tip = np.deg2rad(np.linspace(-31, -15, many))
    rates = {
        "Phase B, arrays": many / seconds(lambda: solve_contact(profile, tangent, THIN)),
        "Phase A, arrays": many / seconds(lambda: solve_contact(profile, tip, THIN)),
    }
    one = solve_contact(profile, [np.deg2rad(-24)], THIN).iloc[0]
    other = solve_contact(profile, [0.0], THIN).iloc[0]
    alpha, eta = one["contact_angle"], one["contact_y"]
    rates["Phase A, the paper's shooting (1e-12)"] = 1 / seconds(
        lambda: tip_angle_by_shooting(alpha, eta)
    )
    rates["Phase A, solve_bvp (1e-10)"] = 1 / seconds(
        lambda: boundary_value_problem(alpha, eta, False)
    )
    rates["Phase B, solve_bvp (1e-10)"] = 1 / seconds(
        lambda: boundary_value_problem(0.0, other["contact_y"], True)
    )
    table = Table(
        "one contact",
        "contacts/s",
        "closed form is faster by",
        title=f"Analytic solver; arrays of {many:,}",
    )
    for name, rate in rates.items():
        own = rates[f"{name[:7]}, arrays"]
        table.add_row(name, f"{rate:,.0f}", f"{own / rate:,.0f}")
    console = Console()
    console.print(table)

    case = named_case("catenary")
    sweep = seconds(lambda: solve_sweep(case))
    console.print(f"200-station sweep, its events located on the way: {1e3 * sweep:.1f} ms")
    some = 64 if quick else 10_000
    begin, last = time.process_time(), 0.0
    tracemalloc.start()
    for done, found in enumerate(solve_sweeps(varied(some)), 1):
        assert isinstance(found, Readings), found
        if done == some // 10:
            last = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
            begin = time.process_time()
    taken = (time.process_time() - begin) / (some - some // 10)
    console.print(
        f"{some:,} such sweeps by solve_sweeps, their cases made on the way: "
        f"{1e3 * taken:.1f} ms each on one core, {last / 1e6:.0f} MB at the most"
    )
    real = Case(Beam(natural_curvature=-0.3), profile, clamp_stiffness=8.0, friction=0.2)
    rate = many / seconds(
        lambda: solve_contact(profile, tangent, real.beam, clamp_stiffness=8.0, friction=0.2)
    )
    console.print(f"Phase B with friction, elastic clamp and natural curvature: {rate:,.0f}/s")
    ratio = seconds(lambda: solve_sweep(real)) / sweep
    console.print(f"the sweep of such a vibrissa takes {ratio:.1f} times as long")
    events = seconds(lambda: find_events(case.profile, case.beam))
    console.print(f"its events alone, with the readings there: {1e3 * events:.1f} ms")
    for count in (many // 10, many):
        angles = np.deg2rad(np.linspace(-31, 30, count))
        tracemalloc.start()
        solve_contact(profile, angles, THIN)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        console.print(
            f"memory for {count:,} contacts: {peak / count:.0f} bytes a contact at its peak"
        )
