"""PyElastica's rod rests where the closed form says; its contact is the gradient of an energy."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Sweep,
    circle,
    named_case,
    polygon,
    solve_sweep,
)
from mujoco_models import Settings

pytest.importorskip("elastica", reason="PyElastica is an extra: pip install '.[pyelastica]'")

from engines import find_engine

TURN = 0.1 + 2 * np.pi * np.arange(6) / 6
HEXAGON = polygon(np.column_stack([0.5 * np.cos(TURN), 0.9 + 0.5 * np.sin(TURN)]))


def off(case: Case, segments: int, stations: int) -> np.ndarray:
    """Rms of each reading before the snap-off, of the largest; all must be settled."""
    case = replace(case, sweep=replace(case.sweep, stations=stations))
    exact, found = (
        solve_sweep(case),
        find_engine("pyelastica").sweep(case, Settings(segments=segments)),
    )
    assert found.trusted.all()
    if case.sweep.stop is None:
        assert abs(found.snap_off - exact.snap_off) < 0.4 / segments**2
    return np.array(
        [
            np.sqrt(((found.values(name) - exact.values(name)) ** 2).mean())
            / np.abs(exact.values(name)).max()
            for name in CLAMP_READINGS
        ]
    )


@pytest.mark.parametrize("name", ["parabola", "tip-only"])
def test_ten_elements_are_the_rod_to_one_in_a_hundred(name):
    """Before the snap-off, near which explicit steps take longest to rest."""
    assert off(replace(named_case(name), sweep=Sweep(stop=0.0)), 10, 4).max() < 1e-2


@pytest.mark.slow
@pytest.mark.parametrize("name", ["catenary", "parabola", "tip-only"])
def test_it_is_of_second_order(name):
    coarse, fine = (off(named_case(name), n, 15) for n in (10, 20))
    assert coarse.max() < 3e-2
    assert fine.max() < 1e-2
    assert np.log2(coarse.max() / fine.max()) > 1.5


@pytest.mark.parametrize("profile", [circle(1.0, (0.0, 0.4)), HEXAGON], ids=["circle", "hexagon"])
def test_contact_forces_are_the_gradient_of_one_energy(profile):
    """Their derivatives are symmetric, whichever nodes and elements touch."""
    from engines.pyelastica.contact import Arcs, push, touch

    arcs, count, touched = Arcs.of(Case(profile=profile)), 6, 0
    places, held = np.zeros(count), np.zeros(2 * count + 1, bool)

    def pushed(nodes: np.ndarray) -> np.ndarray:
        depths, normals = np.zeros(2 * count + 1), np.zeros((2, 2 * count + 1))
        outer = np.zeros((2, count + 1))
        touch(nodes, 0.0, arcs, held, depths, normals, places)
        push(outer, depths * normals, places)
        return outer.ravel()

    random = np.random.default_rng(1)
    for _ in range(200):
        contour = Case(profile=profile).centreline
        on = contour.at(np.array(random.uniform(*Case(profile=profile).reach)))
        along = np.array([np.cos(on.alpha), np.sin(on.alpha)])
        inward = np.array([-along[1], along[0]])
        s = np.linspace(-0.15, 0.15, count + 1) + random.uniform(-0.05, 0.05)
        depth = 1e-3 - random.uniform(0.0, 0.5) * s**2
        nodes = np.array([[on.xi], [on.eta]]) + along[:, None] * s + inward[:, None] * depth
        steps = 1e-7 * np.eye(nodes.size).reshape(-1, *nodes.shape)
        slopes = np.array([(pushed(nodes + d) - pushed(nodes - d)) / 2e-7 for d in steps])
        if np.abs(slopes).max() > 3:  # across the place where a contact begins
            continue
        touched += bool(slopes.any())
        assert np.abs(slopes - slopes.T).max() < 1e-5
    assert touched > 100


def test_past_a_corner_it_rests_or_says_that_it_does_not():
    """Explicit steps may not rest where the vibrissa comes to lie on an edge, over its corner."""
    case = Case(profile=HEXAGON, sweep=Sweep(stations=5, stop=0.1))
    exact, found = solve_sweep(case), find_engine("pyelastica").sweep(case, Settings(segments=10))
    ok = found.trusted
    assert ok.sum() >= 3
    for name in CLAMP_READINGS:
        apart = np.abs(found.values(name) - exact.values(name))[ok]
        assert apart.max() < 2e-2 * np.abs(exact.values(name)).max()


@pytest.mark.parametrize(
    ("case", "says"),
    [
        (named_case("rubbing"), "friction"),
        (named_case("pre-curved"), "natural_curvature"),
        (Case(Beam(radius=0.0), circle(1.0, (0.0, 0.4))), "cannot touch a line"),
    ],
)
def test_what_it_has_not_is_a_line(case, says):
    with pytest.raises(InputError, match=says):
        find_engine("pyelastica").sweep(case, Settings())
