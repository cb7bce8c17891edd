"""Each earlier method is exact, or of the order it should be, where its own theory holds."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

from analytic import Beam, Case, circle, named_case, solve_sweep
from analytic.from_clamp import earlier
from analytic.from_clamp.earlier import Answer, LoadedStations

THIN = Beam(radius=0.0)


def sensed(table, first_contact):
    """Of exact readings."""
    foot_x, x, y, m = (table[n].to_numpy() for n in ("foot_x", "force_x", "force_y", "moment_z"))
    return LoadedStations(foot_x, -x, y, m, first_contact - foot_x)


def swept(profile):
    """Loaded stations of a sweep, and the first contact."""
    sweep = solve_sweep(Case(beam=THIN, profile=profile))
    table = sweep.table[sweep.table["phase"] != "free"].reset_index(drop=True)
    return table, sensed(table, sweep.provenance["events"]["first_contact"])


def errors(answer, table):
    return np.hypot(answer.x - table["contact_x"], answer.y - table["contact_y"]).to_numpy()


def first_tip_phase(table):
    tangent = (table["phase"] == "tangent").to_numpy()
    return np.arange(len(table)) < (np.argmax(tangent) if tangent.any() else len(table))


CONTOURS = {"catenary": named_case("catenary").profile, "circle": circle(1.0, (0.0, 0.4))}


@pytest.mark.parametrize(
    ("method", "contour", "median", "worst"),
    [
        # Median and worst error over the first tip phase [L], from an independent program.
        (earlier.from_moment_and_travel, "catenary", 0.28, 0.64),
        (earlier.from_force_and_moment, "catenary", 0.68, 1.7),
        (earlier.from_beam_column, "catenary", 0.041, 0.15),
        (earlier.from_moment_and_travel, "circle", 0.039, 0.10),
        (earlier.from_force_and_moment, "circle", 0.076, 0.17),
        (earlier.from_beam_column, "circle", 0.003, 0.021),
    ],
)
def test_errors_over_the_first_tip_phase(method, contour, median, worst):
    table, given = swept(CONTOURS[contour])
    found = errors(method(given), table)[first_tip_phase(table)]
    assert np.median(found) == pytest.approx(median, rel=0.1)
    assert found.max() == pytest.approx(worst, rel=0.1)


@pytest.mark.parametrize("contour", CONTOURS)
def test_integration_finds_the_contact(contour):
    table, given = swept(CONTOURS[contour])
    found = errors(earlier.up_to_zero(given), table)
    assert np.median(found) < 1e-12
    assert found.max() < 1e-10


def held(height, delta):
    """Force and moment at the clamp of a vibrissa that a frictionless point holds."""

    def end(unknown):
        force, length, alpha = unknown
        fx, fy = -force * np.sin(alpha), force * np.cos(alpha)
        moment = force * (np.sin(alpha) * height + np.cos(alpha) * delta)

        def rate(_, z):
            x, y, phi = z
            return [np.cos(phi), np.sin(phi), -(moment - fy * x + fx * y)]

        way = solve_ivp(rate, (0, length), [0, 0, np.pi / 2], "DOP853", rtol=1e-12, atol=1e-13)
        x, y, phi = way.y[:, -1]
        return [x - delta, y - height, phi - alpha]

    guess = [3 * delta / height**3, height, np.pi / 2 - 1.5 * delta / height]
    force, _, alpha = fsolve(end, guess, xtol=1e-12)
    across, along = force * np.sin(alpha), force * np.cos(alpha)
    return across, along, across * height + along * delta


@pytest.mark.parametrize(
    ("method", "order"),
    [
        (earlier.from_moment_and_travel, 2),
        (earlier.from_slope_and_travel, 2),
        (earlier.from_force_and_moment, 2),
        (earlier.from_beam_column, 3),
    ],
)
def test_order_in_the_deflection(method, order):
    """A vibrissa that a frictionless point holds aside by delta at the height 0.7."""
    delta = np.array([0.04, 0.02, 0.01])
    across, along, moment = np.array([held(0.7, d) for d in delta]).T
    answer = method(LoadedStations(-delta, across, along, moment, delta))
    error = np.hypot(answer.x, answer.y - 0.7)
    assert np.log2(error[:-1] / error[1:]) == pytest.approx([order] * 2, abs=0.1)


def test_the_slope_next_to_the_clamp_is_the_moment():
    _, given = swept(CONTOURS["circle"])
    near = earlier.from_slope_and_travel(given, sensor=1e-6)
    assert near.y == pytest.approx(earlier.from_moment_and_travel(given).y, rel=1e-5)


@pytest.mark.parametrize("lever", [0.2, 0.5, 0.9])
def test_a_cone_is_deflected_as_its_differential_equation_says(lever):
    force = 1e-3

    def rate(s, z):
        return [z[1], force * (lever - s) / (1 - s) ** 4]

    found = solve_ivp(rate, (0, lever), [0, 0], "DOP853", rtol=1e-13, atol=1e-16).y[0, -1]
    one = np.ones(1)
    answer = earlier.from_force_and_moment_of_cone(
        LoadedStations(0 * one, force * one, 0 * one, force * lever * one, 0 * one)
    )
    assert answer.x[0] == pytest.approx(found, rel=1e-11)
    assert answer.y[0] == pytest.approx(lever)


def test_binary_contact_is_exact_at_the_first_contact():
    table, given = swept(CONTOURS["catenary"])
    found = errors(earlier.binary(given), table)
    assert found[0] < 0.02  # within a station of it
    assert found[-1] > 0.5


@pytest.mark.parametrize(("half_cell", "order"), [(False, 1), (True, 2)])
def test_order_in_the_segments_at_tangential_contacts(half_cell, order):
    table, given = swept(CONTOURS["catenary"])
    tangent = (table["phase"] == "tangent").to_numpy()
    given, table = LoadedStations(*(values[tangent] for values in given)), table[tangent]
    error = []
    for number in (20, 40, 80):
        found = errors(earlier.by_segments(given, number, half_cell), table)
        assert np.isfinite(found).mean() > 0.95
        error.append(np.nanmedian(found))
    observed = np.log2(np.divide(error[:-1], error[1:]))
    assert observed == pytest.approx([order] * 2, abs=0.3)


def contact_under(force, arc_length, number, half_cell):
    """Where the model has the contact, given the force's size and place: its forward problem."""
    whole = np.floor(arc_length * number + 1e-9)
    half = 0.5 / number if half_cell else 0.0
    bent = earlier.bent_from(
        force, np.maximum(arc_length - whole / number, 0.0), whole, number, half
    )
    return Answer(*earlier.from_base(bent))


@pytest.mark.parametrize(
    ("half_cell", "expected"),
    [(False, (0.056, 0.028, 0.014)), (True, (1.2e-3, 2.8e-4, 7.8e-5))],
)
def test_segments_under_the_true_force_at_the_true_place(half_cell, expected):
    """Median error over the tangential contacts [L], from an independent program."""
    table, _ = swept(CONTOURS["catenary"])
    table = table[table["phase"] == "tangent"]
    table = table.iloc[:: len(table) // 40]
    force = np.hypot(table["force_x"], table["force_y"]).to_numpy()
    for number, median in zip((20, 40, 80), expected, strict=True):
        found = contact_under(force, table["contact_arc_length"].to_numpy(), number, half_cell)
        off = np.hypot(
            found.x - (table["contact_x"] - table["foot_x"]), found.y - table["contact_y"]
        )
        assert np.median(off) == pytest.approx(median, rel=0.1)
