"""Random contours, and what is wrong with sweeps along them.

`python -m tests.fuzz.contours N SEED` prints how many sweeps ended in an exception, were refused,
or have a station that is called "ok" and is not: its contact is more than 1e-11 from where the
integration from the clamp leads, the vibrissa passes through the body, or an earlier equilibrium
was passed over.
"""

import sys
import time
import traceback
import warnings
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import pandas as pd
from scipy.optimize import brentq
from scipy.spatial import ConvexHull

from analytic import (
    Beam,
    Case,
    InputError,
    Profile,
    Sweep,
    catenary,
    certify,
    circle,
    ellipse,
    find_events,
    parabola,
    polygon,
    solve_sweep,
    through_points,
    two_circles,
)
from analytic.checks.integration import integrate_span
from analytic.problem.contours.contour import Contour
from analytic.solver.equilibria import equilibria

Placed: TypeAlias = Callable[[float], Contour]
"""A contour by the height of its lowest point."""

EXACT = 1e-11  # of the contact's position [L] and of angles [rad]
HALF_TURN = np.pi / 2


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """A number whose logarithm is uniform."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def any_catenary(rng) -> Placed:
    a = log_uniform(rng, 1e-3, 30)
    return lambda low: catenary(a, low - 1)


def any_parabola(rng) -> Placed:
    a = log_uniform(rng, 1e-3, 100) if rng.random() < 0.9 else log_uniform(rng, 1e-12, 1e-3)
    return lambda low: parabola(a, low)


def any_circle(rng) -> Placed:
    radius = log_uniform(rng, 1e-3, 10) if rng.random() < 0.8 else log_uniform(rng, 10, 1e6)
    x = rng.uniform(-2, 2)
    return lambda low: circle(radius, (x, low))


def any_ellipse(rng) -> Placed:
    if rng.random() < 0.5:
        axes = log_uniform(rng, 0.05, 10), log_uniform(rng, 0.05, 10)
    else:  # a needle
        axes = log_uniform(rng, 1, 20), log_uniform(rng, 1e-3, 0.1)
        axes = axes[:: rng.choice([-1, 1])]
    x = rng.uniform(-2, 2)
    return lambda low: ellipse(axes, (x, low))


def any_two_circles(rng) -> Placed:
    radii = log_uniform(rng, 0.03, 10), log_uniform(rng, 0.03, 10)
    if rng.random() < 0.2:
        radii = (8.1, 0.054)[:: rng.choice([-1, 1])]
    return lambda low: two_circles(*radii, (0.0, low))


def any_exponential(rng) -> Placed:
    """y = b ((exp(k x) - 1)/k - x)/k."""
    k, b = log_uniform(rng, 0.1, 5) * rng.choice([-1, 1]), log_uniform(rng, 0.1, 10)
    steep = HALF_TURN - 1e-3
    pole = -np.arctan(b / k)
    ends = (pole + 1e-3, steep) if k > 0 else (-steep, pole - 1e-3)
    given = rng.random() < 0.5

    def growth(alpha):
        return 1 + np.tan(alpha) * k / b

    def at(low):
        return Profile(
            xi=lambda a: np.log(growth(a)) / k,
            eta=lambda a: low + b / k**2 * (growth(a) - 1 - np.log(growth(a))),
            alpha_range=ends,
            radius_of_curvature=(lambda a: 1 / (b * np.cos(a) ** 3 * growth(a))) if given else None,
            label=f"exponential k {k:.17g} b {b:.17g}",
        )

    return at


def from_support(support, slope, radius, ends, label) -> Placed:
    """The contour of a support function h(alpha), with h' and perhaps h + h''."""

    def eta(a):
        return slope(a) * np.sin(a) - support(a) * np.cos(a)

    bottom = eta(np.clip(0.0, *ends))
    return lambda low: Profile(
        xi=lambda a: support(a) * np.sin(a) + slope(a) * np.cos(a),
        eta=lambda a: eta(a) + (low - bottom),
        alpha_range=ends,
        radius_of_curvature=radius,
        label=label,
    )


def some_range(rng):
    if rng.random() < 0.5:
        return -HALF_TURN, HALF_TURN
    ends = np.sort(rng.uniform(-HALF_TURN, HALF_TURN, 2))
    if rng.random() < 0.7:
        ends = np.array([-1, 1]) * rng.uniform(0.05, HALF_TURN, 2)
    return float(ends[0]), float(max(ends[1], ends[0] + 0.02))


def any_support(rng) -> Placed:
    base, order = log_uniform(rng, 0.02, 5), np.arange(2, rng.integers(3, 12))
    share = rng.dirichlet(np.ones(len(order))) * rng.uniform(0, 0.98)
    wave, shift = base * share / (order**2 - 1), rng.uniform(0, 2 * np.pi, len(order))
    centre = rng.uniform(-2, 2)

    def sum_of(weights, curve, a):
        phase = np.multiply.outer(np.asarray(a, dtype=float), order) + shift
        return curve(phase) @ weights

    return from_support(
        lambda a: base + centre * np.sin(a) + sum_of(wave, np.cos, a),
        lambda a: centre * np.cos(a) - sum_of(wave * order, np.sin, a),
        (lambda a: base - sum_of(wave * (order**2 - 1), np.cos, a)) if rng.random() < 0.6 else None,
        some_range(rng),
        f"support function of radius {base:.4g}",
    )


def any_nearly_polygon(rng) -> Placed:
    """A sum of needles: smooth, with nearly straight sides and sharp turns."""
    count = rng.integers(2, 8)
    tilt = rng.uniform(0, np.pi, count)
    a, b = np.exp(rng.uniform(np.log(0.1), np.log(3), count)), log_uniform(rng, 1e-3, 0.1)

    def parts(alpha):
        turned = np.subtract.outer(np.asarray(alpha, dtype=float), tilt)
        return turned, np.sqrt((a * np.sin(turned)) ** 2 + (b * np.cos(turned)) ** 2)

    def slope(alpha):
        turned, each = parts(alpha)
        return ((a**2 - b**2) * np.sin(turned) * np.cos(turned) / each).sum(axis=-1)

    return from_support(
        lambda alpha: parts(alpha)[1].sum(axis=-1),
        slope,
        lambda alpha: ((a * b) ** 2 / parts(alpha)[1] ** 3).sum(axis=-1),
        some_range(rng),
        f"sum of {count} needles {b:.3g} thin",
    )


def any_polygon(rng) -> Placed:
    if rng.random() < 0.5:
        corners = rng.integers(3, 60)
        turn = rng.uniform(0, 2 * np.pi) + 2 * np.pi * np.arange(corners) / corners
        points = log_uniform(rng, 0.05, 3) * np.column_stack([np.cos(turn), np.sin(turn)])
    else:
        cloud = rng.normal(size=(rng.integers(5, 300), 2)) * [
            log_uniform(rng, 0.1, 3),
            log_uniform(rng, 0.1, 3),
        ]
        points = cloud[ConvexHull(cloud).vertices]
    return lambda low: polygon(np.add(points, [0, low - points[:, 1].min()]))


def any_through_points(rng) -> Placed:
    whole = any_support(rng)(0.0) if rng.random() < 0.5 else any_ellipse(rng)(0.0)
    left, right = whole.alpha_range
    angles = np.sort(rng.uniform(left, right, rng.integers(3, 15)))
    points = np.column_stack([whole.xi(angles), whole.eta(angles)])
    bottom = through_points(points).at(np.zeros(1)).eta[0]
    return lambda low: through_points(np.add(points, [0, low - bottom]))


KINDS = {
    "catenary": any_catenary,
    "parabola": any_parabola,
    "circle": any_circle,
    "ellipse": any_ellipse,
    "two circles": any_two_circles,
    "exponential": any_exponential,
    "support": any_support,
    "nearly polygon": any_nearly_polygon,
    "polygon": any_polygon,
    "through points": any_through_points,
}
NUDGES = (0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6)


def any_case(kind: str, rng) -> Case:
    """A sweep along a contour of `kind`; a good part of them stops on an event or close to one."""
    placed = KINDS[kind](rng)
    length = log_uniform(rng, 1e-2, 1e2) if rng.random() < 0.3 else 1.0
    radius = rng.uniform(0, 0.05) if rng.random() < 0.6 else 0.0
    beam = Beam(length, log_uniform(rng, 1e-3, 1e3), radius * length)

    def body(height):
        return placed(height + radius).scaled(length)

    height = rng.uniform(0.03, 0.97)
    if rng.random() < 0.1:
        height = tuned(body, beam, 1 - 10 ** rng.uniform(-15, -2), height)
    stations = int(rng.integers(9, 60))
    profile = body(height)
    chosen = rng.random()
    if chosen < 0.5:
        direction = "right" if rng.random() < 0.2 else "left"
        return Case(beam, profile, Sweep(stations, direction=direction), name=kind)
    events = find_events(profile, beam)
    places = [event.foot_x for event in vars(events).values() if event and event.foot_x < np.inf]
    place = float(rng.choice(places)) + float(rng.choice(NUDGES)) * length
    first = events.first_contact.foot_x
    if chosen < 0.6:
        place = first - 10 ** rng.uniform(-16, -6) * length
    start = first if rng.random() < 0.3 else first + 0.01 * length
    stop = place if place < start - 1e-13 * abs(start) else None
    return Case(beam, profile, Sweep(stations, start, stop), name=kind)


def tuned(body, beam, aim, otherwise):
    """The height at which the least contact length of eq. 21 is `aim` [L]."""

    def missed(height):
        found = find_events(body(height), beam)
        return found.contact_length_minimum.contact_arc_length / beam.length - aim

    low, high = 0.05, 0.95
    if not missed(low) < 0 < missed(high):
        return otherwise
    return brentq(missed, low, high, xtol=1e-15)


def faults(case: Case) -> list[str]:
    """What is wrong with the sweep along a contour, each fault in a few words."""
    readings = solve_sweep(case)
    find_events(case.profile, case.beam)
    table, beam = readings.table, case.beam
    found = []
    touching = (table["phase"] != "free").to_numpy()
    ok = (table["status"] == "ok").to_numpy()
    if (~ok).any():
        found.append("not ok: " + ", ".join(sorted(set(table["status"][~ok]))))
    if not (touching & ok).any():
        return found
    extent = np.maximum(1, np.abs(table[["foot_x", "contact_x"]].max(axis=1)) / beam.length)
    misses = certify(readings)
    # A load moves the moment by its own size times what the place is off.
    load = np.hypot(table["force_x"], table["force_y"]) / beam.force_unit
    misses["residual_moment"] /= np.maximum(1, load)
    error = (misses.max(axis=1) / extent).to_numpy()[ok & touching]
    if not (error <= EXACT).all():
        found.append(f"off by {np.max(np.nan_to_num(error, nan=np.inf)):.1e}")
    arc_length = readings.values("contact_arc_length")[ok & touching] / beam.length
    if not (arc_length <= 1 + 1e-14).all():
        found.append(f"longer than the vibrissa by {arc_length.max() - 1:.1e}")
    if case.sweep.direction == "left":
        found += passed_over(case, readings, touching & ok)
        found += penetration(case, readings, touching & ok)
    return found


def passed_over(case, readings, here) -> list[str]:
    """An equilibrium that the sweep meets before the one that it states, on a dense grid."""
    left, right = case.reach
    breaks = case.centreline.breaks()
    grid = np.unique([*np.linspace(left, right, 1001), *breaks[(breaks > left) & (breaks < right)]])
    grid = grid[-2::-1]  # without the first contact itself, where nothing is loaded yet
    with np.errstate(all="ignore"):
        foot_x = equilibria(case.centreline, grid).foot_x
    reached = np.isfinite(foot_x)
    end = len(grid) if reached.all() else int(np.argmin(reached))
    if end == 0:
        return []
    grid, least = grid[:end], np.minimum.accumulate(foot_x[:end])
    extent = max(1.0, np.abs(least).max())
    snap_off = readings.snap_off / case.beam.length
    found = []
    if least[-1] < snap_off - EXACT * extent:
        found.append(f"snap-off missed by {snap_off - least[-1]:.1e}")
    foot_x = readings.values("foot_x")[here] / case.beam.length
    own = case.centreline.at(grid)
    x, y = (readings.values(name)[here] / case.beam.length for name in ("contact_x", "contact_y"))
    # Places on the contour in order: by slope angle, and along straight parts by position.
    radius, angle = case.radius, readings.values("contact_angle")[here]
    along = x + radius * np.sin(angle) + (y - radius * np.cos(angle)) * np.sign(angle)
    place = angle + along / extent
    order = own.alpha + (own.xi + own.eta * np.sign(own.alpha)) / extent
    before = np.searchsorted(-order, -place, side="left") - 1
    sooner = np.where(before > 0, foot_x - least[np.maximum(before, 0)], 0.0)
    if sooner.size and sooner.max() > 1e-9 * extent:  # next to a fold angles differ by rounding
        found.append(f"passed over by {sooner.max():.1e}")
    return found


def penetration(case, readings, here) -> list[str]:
    """How deep the deflected centreline lies inside what it may not enter."""
    beam = case.beam

    def column(name, unit):
        return readings.values(name)[here] / unit

    force = [column(name, beam.force_unit) for name in ("force_x", "force_y")]
    moment = column("moment_z", beam.moment_unit)
    length = column("contact_arc_length", beam.length)
    left, right = case.centreline.t_range
    samples = case.centreline.at(np.linspace(left, right, 181))
    normal = np.array([np.sin(samples.alpha), -np.cos(samples.alpha)])
    finite = np.isfinite(samples.xi) & np.isfinite(samples.eta)
    support = (normal * [samples.xi, samples.eta]).sum(axis=0)[finite]
    own = column("contact_angle", 1.0)
    at = case.centreline.at(case.centreline.parameter(own))
    depth = 0.0
    for share in np.linspace(0.1, 1, 10):
        end = integrate_span(*force, moment, share * length, tolerance=1e-8)
        x, y = end.x + column("foot_x", beam.length), end.y
        outside = (np.multiply.outer(x, normal[0]) + np.multiply.outer(y, normal[1]))[:, finite]
        beyond = np.sin(own) * (x - at.xi) - np.cos(own) * (y - at.eta)
        depth = max(depth, -float(np.maximum((outside - support).max(axis=1), beyond).min()))
    # The contact itself lies on the contour up to the integration's error.
    return [f"penetrates by {depth:.1e}"] if depth > 1e-6 else []


def trial(kind: str, seed: int) -> tuple[str, list[str]]:
    """One contour: whether it was "solved", "refused" or ended in an "exception", and why."""
    rng = np.random.default_rng([list(KINDS).index(kind), seed])
    try:
        case = any_case(kind, rng)
    except InputError as error:
        return "refused", [str(error).split(" = ")[0].split("(")[0]]
    except Exception as error:
        return "exception", [where(error)]
    try:
        return "solved", faults(case)
    except Exception as error:
        return "exception", [where(error)]


def where(error: Exception) -> str:
    last = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__} in {last.name}, line {last.lineno}"


def main(number: int, seed: int) -> None:
    """Do trials; prints the outcomes by kind, and who shows each fault."""
    kinds, rows = list(KINDS), []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for i in range(seed * 1_000_000, seed * 1_000_000 + number):
            outcome, found = trial(kinds[i % len(kinds)], i)
            for fault in found or [""]:
                at_fault = fault and outcome == "solved"
                short = fault if outcome == "refused" else fault.split(" by ")[0]
                rows.append((kinds[i % len(kinds)], i, "at fault" if at_fault else outcome, short))
    table = pd.DataFrame(rows, columns=["kind", "seed", "outcome", "fault"])
    each = table.drop_duplicates("seed")
    print(pd.crosstab(each["kind"], each["outcome"], margins=True))
    for (outcome, fault), who in table[table["fault"] != ""].groupby(["outcome", "fault"]):
        some = "" if outcome == "refused" else who[["kind", "seed"]].head(4).to_string(header=False)
        print(f"{len(who):6} {outcome}: {fault}\n{some}")
    print(f"{time.process_time():.0f} s of CPU")


if __name__ == "__main__":
    main(*(int(argument) for argument in sys.argv[1:3]))
