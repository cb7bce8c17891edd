"""The friction coefficient from the clamp."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    Beam,
    Case,
    InputError,
    Readings,
    Sweep,
    catenary,
    circle,
    estimate_friction,
    named_case,
    parabola,
    reconstruct,
    relative_noise,
    solve_sweep,
)
from analytic.problem.support import Support
from tests.analytic.noisy import noisy


def swept(
    friction, natural=0.0, stiffness=np.inf, radius=0.005, direction="left", stations=200, tip=None
):
    return solve_sweep(
        Case(
            Beam(radius=radius, natural_curvature=natural, tip_radius=tip),
            circle(1.0, lowest=(0, 0.4)),
            Sweep(stations, direction=direction),
            clamp_stiffness=stiffness,
            friction=friction,
        )
    )


@pytest.mark.parametrize("direction", ["left", "right"])
@pytest.mark.parametrize(
    ("friction", "natural", "stiffness", "radius"),
    [
        (0.0, 0.0, np.inf, 0.005),
        (0.3, 0.0, np.inf, 0.0),
        (0.3, 0.0, np.inf, 0.02),
        (0.6, -0.4, 6.0, 0.02),
        (0.05, 0.3, 3.0, 0.005),
    ],
)
def test_exact_readings_show_it_exactly(friction, natural, stiffness, radius, direction):
    natural = natural if direction == "left" else -natural
    readings = swept(friction, natural, stiffness, radius, direction)
    found = estimate_friction(readings.with_friction(0.0))
    assert found.coefficient == pytest.approx(friction, abs=1e-12)
    assert found.stations > 20 and found.uncertainty < 1e-3


@pytest.mark.parametrize(
    ("friction", "tip", "natural", "stiffness", "direction"),
    [
        (0.3, 0.4, 0.0, np.inf, "left"),
        pytest.param(0.2, 0.1, 0.4, 6.0, "right", marks=pytest.mark.slow),
    ],
)
def test_a_cone_shows_it_too(friction, tip, natural, stiffness, direction):
    """What is wrong with the friction assumed moves the contact by the radius times that."""
    readings = swept(friction, natural, stiffness, 0.01, direction, 30, 0.01 * tip)
    found = estimate_friction(readings.with_friction(0.0))
    assert found.coefficient == pytest.approx(friction, abs=1e-11)  # observed 3e-12


def errors(level, tip, times):
    """Of noisy sweeps, each over its own uncertainty."""
    exact = swept(0.3, stations=100, tip=tip).with_friction(0.0)
    noise, rng = relative_noise(exact, level), np.random.default_rng(1)
    for _ in range(times):
        found = estimate_friction(noisy(exact, noise, rng), noise)
        yield (found.coefficient - 0.3) / found.uncertainty


@pytest.mark.parametrize(
    ("level", "tip"),
    [
        pytest.param(1e-3, None, marks=pytest.mark.slow),
        pytest.param(1e-2, None, marks=pytest.mark.trial),
        pytest.param(3e-2, None, marks=pytest.mark.slow),
        pytest.param(1e-2, 0.002, marks=pytest.mark.trial),
    ],
)
def test_uncertainty_covers_the_error(level, tip):
    """95 % of 100 noisy sweeps, so +-2.2 %."""
    assert sum(abs(error) <= 1 for error in errors(level, tip, 100)) >= 89


@pytest.mark.slow
def test_the_uncertainty_of_a_cone_is_as_large_as_estimates_scatter():
    """Twelve errors over standard deviations: their mean square is 1 +- 0.4.

    Of an uncertainty half as large it is four times as much.
    """
    squares = [(1.96 * error) ** 2 for error in errors(1e-2, 0.002, 12)]
    assert 0.3 < np.mean(squares) < 2.0


def test_noise_is_stated_as_uncertainty():
    exact = swept(0.3, stations=100).with_friction(0.0)
    noise = relative_noise(exact, 1e-2)
    found = estimate_friction(noisy(exact, noise, 1), noise)
    assert 0.003 < found.uncertainty < 0.02
    assert abs(found.coefficient - 0.3) < 2 * found.uncertainty


def test_passes_are_pooled():
    """Four, to both sides: half of one's uncertainty."""
    ways = [swept(0.3, stations=60, direction=way).with_friction(0.0) for way in ("left", "right")]
    noise = relative_noise(ways, 1e-2)
    passes = [noisy(one, noise, seed) for seed, one in enumerate(2 * ways)]
    one, four = (estimate_friction(some, noise) for some in (passes[:1], passes))
    assert four.uncertainty == pytest.approx(one.uncertainty / 2, rel=0.3)
    assert abs(four.coefficient - 0.3) < 2 * four.uncertainty
    assert four.passes.consistent and one.passes is None
    assert not estimate_friction([*passes, swept(0.0, stations=60)]).passes.consistent


def test_the_object_is_found_without_knowing_the_friction():
    readings = swept(0.4, -0.3, 6.0)
    found = estimate_friction(readings.with_friction(0.0))
    angle = reconstruct(readings.with_friction(found.coefficient))["contact_angle"]
    wrong = reconstruct(readings.with_friction(0.0))["contact_angle"]
    true = readings.values("contact_angle")
    assert np.nanmax(np.abs(angle - true)) < 1e-12
    assert np.nanmin(np.abs(wrong - true)) == pytest.approx(np.arctan(0.4), rel=1e-9)


def test_only_phase_b_shows_it():
    raised = replace(named_case("tip-only"), friction=0.3)
    with pytest.raises(InputError, match="stations of Phase B = 0: must be 5 or more"):
        estimate_friction(solve_sweep(raised))
    with pytest.raises(InputError, match="readings"):
        estimate_friction(raised)


@pytest.mark.parametrize("profile", [catenary(0.5, -0.8), parabola(0.5, 0.5)])
def test_no_friction_is_not_taken_for_some(profile):
    found = estimate_friction(solve_sweep(Case(profile=profile)))
    assert abs(found.coefficient) < 1e-12


def test_readings_say_what_rubs():
    readings = swept(0.3, stiffness=6.0)
    assert readings.support == Support(6.0, 0.3)
    assert readings.with_friction(0.0).support == Support(6.0)
    bare = Readings(readings.table, readings.beam)
    assert bare.with_friction(0.2).support == Support(friction=0.2)
    assert "support" not in bare.with_friction(0.0).provenance


def remembering(readings, level, seed):
    """With AR(0.9) noise that nobody states."""
    return noisy(readings, relative_noise(readings, level), seed, memory=0.9)


@pytest.mark.parametrize("seed", range(5))
def test_noise_that_remembers_makes_no_phase_b(seed):
    """Tips that it seems to lay down gave -0.47 +- 0.18, or 0.17 +- 0.02 instead of 0.3."""
    short = solve_sweep(Case(Beam(), circle(0.3, lowest=(0, 0.8)), Sweep(200), friction=0.14))
    with pytest.raises(InputError, match="stations of Phase B"):
        estimate_friction(remembering(short, 0.01, seed))


@pytest.mark.parametrize("seed", range(5))
def test_noise_next_to_no_load_says_nothing_of_friction(seed):
    """It gave -1.0 +- 0.3, or -22."""
    long = Sweep(400, 0.5, -0.9)
    case = Case(Beam(radius=0.002), circle(0.34, lowest=(0.05, 0.7)), long, friction=0.2)
    found = estimate_friction(remembering(solve_sweep(case), 0.003, seed))
    assert found.coefficient == pytest.approx(0.2, abs=1.5 * found.uncertainty)
    assert found.uncertainty < 0.03


@pytest.mark.parametrize(("radius", "height"), [(0.5, 0.5), (0.4, 0.6)])
def test_hum_next_to_no_load_says_nothing_of_friction(radius, height):
    """It gave -0.03 and 0.03 instead of 0.2, each +- 0.01."""
    case = Case(Beam(radius=0.002), circle(radius, lowest=(0.05, height)), Sweep(300), friction=0.2)
    exact, turn = solve_sweep(case), 2 * np.pi * np.arange(300) / 17.3
    sizes = relative_noise(exact, 0.004).items()
    hum = {n: exact.values(n) + size * np.sin(turn + i) for i, (n, size) in enumerate(sizes)}
    found = estimate_friction(Readings(exact.table.assign(**hum), exact.beam))
    assert found.coefficient == pytest.approx(0.2, abs=found.uncertainty)
    assert found.uncertainty < 0.01
