"""The closed forms against the paper's shooting and collocation, their memory, and many sweeps."""

import resource
import sys
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
    space,
)
from analytic.checks import boundary_value_problem, tip_angle_by_shooting
from analytic.solver.general.sweep import solve
from tests.bench.timing import least_seconds

THIN = Beam(radius=0.0)
COUNT, SWEEPS = 100_000, 1_000_000
_MIB = 2**20 if sys.platform == "darwin" else 2**10  # the unit of `ru_maxrss`


def main(quick: bool) -> None:
    many = COUNT // 100 if quick else COUNT
    profile = catenary(0.5, -0.8)
    tangent = np.deg2rad(np.linspace(-14, 30, many))
    tip = np.deg2rad(np.linspace(-31, -15, many))
    one = solve_contact(profile, [np.deg2rad(-24)], THIN).iloc[0]
    other = solve_contact(profile, [0.0], THIN).iloc[0]
    alpha, eta = one["contact_angle"], one["contact_y"]
    seconds = {
        "Phase B, arrays": least_seconds(lambda: solve_contact(profile, tangent, THIN)) / many,
        "Phase A, arrays": least_seconds(lambda: solve_contact(profile, tip, THIN)) / many,
        "Phase A, the paper's shooting (1e-12)": least_seconds(
            lambda: tip_angle_by_shooting(alpha, eta)
        ),
        "Phase A, solve_bvp (1e-10)": least_seconds(
            lambda: boundary_value_problem(alpha, eta, False)
        ),
        "Phase B, solve_bvp (1e-10)": least_seconds(
            lambda: boundary_value_problem(0.0, other["contact_y"], True)
        ),
    }
    table = Table(
        "one contact",
        "contacts/s",
        "closed form is faster by",
        title=f"Analytic solver; arrays of {many:,}",
    )
    for name, took in seconds.items():
        table.add_row(name, f"{1 / took:,.0f}", f"{took / seconds[f'{name[:7]}, arrays']:,.0f}")
    console, case = Console(), named_case("catenary")
    console.print(table)
    real = Case(Beam(natural_curvature=-0.3), profile, clamp_stiffness=8.0, friction=0.2)
    ratio = least_seconds(lambda: solve_sweep(real)) / least_seconds(lambda: solve_sweep(case))
    console.print(f"a sweep with friction, elastic clamp and natural curvature: {ratio:.1f} times")
    events = least_seconds(lambda: find_events(case.profile, case.beam))
    console.print(f"its events alone, with the readings there: {1e3 * events:.1f} ms")
    two, feet = (
        Case(Beam(radius=0.0, natural_curvature=0.5), profile),
        np.linspace(1.17, -1.58, many),
    )
    rate = many / least_seconds(lambda: solve(two, feet), 1)
    console.print(f"two contacts at once, {many:,} stations: {rate:,.0f} a second")
    path = space.FootPath([[1.1, 0.3], [-0.2, 0.1]], stations=many // 50)
    ball = space.sphere(1.0, centre=(0, 1.4, 0))
    rubbing = space.SpatialCase(THIN, body=ball, path=path, friction=0.3)
    rate = many // 50 / least_seconds(lambda: space.solve_space(rubbing), 1)
    console.print(f"friction in space, {many // 50:,} stations: {rate:,.0f} a second")
    for count in (many // 10, many):
        angles = np.deg2rad(np.linspace(-31, 30, count))
        tracemalloc.start()
        solve_contact(profile, angles, THIN)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        console.print(
            f"memory for {count:,} contacts: {peak / count:.0f} bytes a contact at its peak"
        )


def million(quick: bool) -> None:
    """A million sweeps to the end, in flat memory: what they took after 10^2, 10^3 and so on."""
    count = SWEEPS // 10_000 if quick else SWEEPS
    begin, following, snap_offs = time.process_time(), 100, 0
    for done, found in enumerate(solve_sweeps(varied(count)), 1):
        assert isinstance(found, Readings), found
        snap_offs += found.snap_off is not None
        if done == following:
            taken = time.process_time() - begin
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / _MIB
            print(
                f"{done:,} sweeps, {snap_offs:,} of them with a snap-off: {taken:,.1f} s of one "
                f"core, {1e3 * taken / done:.2f} ms each; {peak:.0f} MiB at the most so far",
                flush=True,
            )
            following *= 10


def varied(count: int) -> Iterator[Case]:
    """Vibrissae of 200 stations past catenaries and circles, none like another."""
    numbers = np.random.default_rng(0)
    for i in range(count):
        width, size, radius = numbers.uniform((0.3, 0.7, 1e-3), (0.8, 2.0, 1e-2))
        profile = circle(size, (0.0, 0.4)) if i % 2 else catenary(width, -0.8)
        yield Case(Beam(radius=radius), profile)
