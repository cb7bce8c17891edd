"""The closed forms against the paper's shooting and collocation, and their memory."""

import tracemalloc

import numpy as np
from rich.console import Console
from rich.table import Table

from analytic import Beam, Case, catenary, find_events, named_case, solve_contact, solve_sweep
from analytic.checks import boundary_value_problem, tip_angle_by_shooting
from tests.bench.timing import seconds

THIN = Beam(radius=0.0)
COUNT = 100_000


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
