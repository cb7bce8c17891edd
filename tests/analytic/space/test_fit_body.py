"""Sphere, ellipsoid and cylinder from the clamp alone: exact without noise, known with it."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import Beam, InputError
from analytic.space import (
    FootPath,
    SpatialCase,
    cylinder,
    ellipsoid,
    fit_body,
    polyhedron,
    solve_space,
    sphere,
)
from analytic.space.problem.readings import FORCE, MOMENT
from tests.analytic.noisy import noisy

AXIS = np.array([0.1, 0.05, 1]) / np.linalg.norm([0.1, 0.05, 1])
BODIES = {
    "sphere": (
        sphere(1.0, (0.05, 1.4, 0)),
        {"radius": 1.0, "centre_x": 0.05, "centre_y": 1.4, "centre_z": 0.0},
    ),
    "ellipsoid": (
        ellipsoid((1, 0.7, 1.6), (0, 1.1, 0.02)),
        {"semi_axis_x": 1.0, "semi_axis_y": 0.7, "semi_axis_z": 1.6, "centre_z": 0.02},
    ),
    "cylinder": (
        cylinder(0.8, (0, 1.2, 0), AXIS),
        {"radius": 0.8, **{f"axis_{x}": a for x, a in zip("xyz", AXIS, strict=True)}},
    ),
}
WAYS = [[[1.3, 0.3], [-1.5, 0.3]], [[1.3, -0.2], [-1.3, 0.1]]]


def swept(body, stations=50):
    """Past it, to the left, along two lines."""
    paths = [FootPath(way, stations=stations, tangent=(0.1, 1, 0.05)) for way in WAYS]
    return [solve_space(SpatialCase(body=body, path=path)) for path in paths]


def sizes(sweeps, share):
    """Of noise: a share of the largest component, of force and of moment."""
    return {
        name: share * max(np.nanmax(np.abs(one.values(*group))) for one in sweeps)
        for group in (FORCE, MOMENT)
        for name in group
    }


@pytest.mark.parametrize("seed", range(2))
def test_noise_that_remembers_is_no_contact_behind_the_slip_off(seed):
    """Of AR(0.9), which jumps little, nine of twelve spheres were refused, the others wrong."""
    body, true = BODIES["sphere"]
    clean = swept(body, 100)
    draw, noise = np.random.default_rng(seed), sizes(clean, 0.003)
    found = fit_body([noisy(one, noise, draw, memory=0.9) for one in clean]).found
    for name, value in true.items():
        # Twice a 95 % interval either way: four of each of three draws are to be in it.
        half = found[name].highest - found[name].lowest
        assert found[name].value == pytest.approx(value, abs=half)
        assert half < 0.1


@pytest.mark.slow
def test_a_contact_that_noise_moves_far_does_not_count():
    """One station of little force left 20 to 80 times its noise: six of 40 right fits refused."""
    body = cylinder(0.5, (0.1, 1.2, 0.0), (0.3, 0.0, 1.0))
    paths = [FootPath([[1.5, z], [-1.7, z + 0.1]], stations=120) for z in (-0.2, 0.15, 0.5)]
    clean = [solve_space(SpatialCase(body=body, path=path)) for path in paths]
    noise, draw = sizes(clean, 0.003), np.random.default_rng(7)
    assert fit_body([noisy(one, noise, draw) for one in clean], "cylinder", noise).explains


@pytest.fixture(scope="module")
def sweeps():
    return {name: swept(body) for name, (body, _) in BODIES.items()}


@pytest.mark.slow
@pytest.mark.parametrize("name", BODIES)
def test_exact_readings_give_the_body_and_its_family(sweeps, name):
    found = fit_body(sweeps[name], "auto")
    assert (found.family, found.explains) == (name, True)
    for quantity, true in BODIES[name][1].items():
        assert found.found[quantity].value == pytest.approx(true, abs=1e-9), quantity
    spot = found.body.nearest(np.array([0.3, -0.2, 0.1]), 1.0)
    true = BODIES[name][0].nearest(np.array([0.3, -0.2, 0.1]), 1.0)
    np.testing.assert_allclose(spot.point, true.point, atol=1e-9)


@pytest.mark.slow
def test_in_units():
    mm, wire = 1e-3, Beam(0.05, 2e-6, 2.5e-4)
    egg = ellipsoid((50 * mm, 35 * mm, 80 * mm), (0, 55 * mm, 0))
    paths = [FootPath(np.array(way) * 50 * mm, tangent=(0.1, 1, 0.05)) for way in WAYS]
    found = fit_body(
        [solve_space(SpatialCase(wire, body=egg, path=path)) for path in paths], "auto"
    )
    assert found.found["semi_axis_z"].value == pytest.approx(80 * mm, abs=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("name", BODIES)
def test_intervals_hold(sweeps, name):
    """Of 40 draws of 1 % of noise; 95 % of each quantity's, which fewer than 33 are once in 1e4."""
    draw = np.random.default_rng(3)
    noise = sizes(sweeps[name], 0.01)
    inside = dict.fromkeys(BODIES[name][1], 0)
    for _ in range(40):
        found = fit_body([noisy(one, noise, draw) for one in sweeps[name]], name, noise)
        for quantity, true in BODIES[name][1].items():
            one = found.found[quantity]
            inside[quantity] += one.lowest <= true <= one.highest
    assert min(inside.values()) >= 33, inside


@pytest.mark.slow
def test_another_body_is_none_of_them(sweeps):
    corners = np.array(np.meshgrid([-0.6, 0.6], [0.6, 1.4], [-0.7, 0.7])).reshape(3, -1).T
    box = swept(polyhedron(corners))
    with pytest.raises(InputError, match="none of them"):
        fit_body(box, "auto")
    found = fit_body(sweeps["ellipsoid"], "auto")
    assert found.family == "ellipsoid" and not found.rivals.get("sphere", (0.0, False))[1]


def test_rows_without_readings_show_no_noise():
    """Behind a slip-off, of readings without noise: it was a warning of NumPy's."""
    path = FootPath(WAYS[0], stations=120, tangent=(0.1, 1, 0.05))
    one = solve_space(SpatialCase(body=BODIES["sphere"][0], path=path))
    lost = one.table.index >= one.table.index[one.table["phase"] != "free"][-1] + 1
    nothing = one.table.assign(**{n: one.table[n].where(~lost) for n in (*FORCE, *MOMENT)})
    assert lost.sum() >= 10
    assert fit_body([replace(one, table=nothing)], "sphere").explains


@pytest.mark.slow
def test_what_says_too_little_is_a_line(sweeps):
    with pytest.raises(InputError, match=r"family = 'circle'.*sphere"):
        fit_body(sweeps["sphere"], "circle")
    few = sweeps["sphere"][0]
    touched = np.flatnonzero(few.table["phase"] != "free")
    with pytest.raises(InputError, match="contacts of a sweep = "):
        fit_body(replace(few, table=few.table.iloc[: touched[3] + 1]), "auto")


@pytest.mark.slow
def test_gaps_and_a_sweep_that_touches_nothing(sweeps):
    """What is missing is left out; a pass that shows nothing is named."""
    gapped = sweeps["sphere"][0]
    table = gapped.table.copy()
    table.loc[20:22, "force_x"] = np.nan
    found = fit_body(replace(gapped, table=table), "sphere")
    assert found.found["radius"].value == pytest.approx(1.0, abs=1e-9)
    idle = replace(gapped, table=gapped.table.iloc[:3])
    with pytest.raises(InputError, match=r"contacts of a sweep = 0.*leave the sweep out"):
        fit_body([gapped, idle], "sphere")
