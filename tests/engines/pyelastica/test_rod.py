"""PyElastica's rod rests where the closed form says; its contact is the gradient of an energy."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    Sweep,
    circle,
    named_case,
    polygon,
    solve_sweep,
)
from engines import find_engine
from mujoco_models import Settings
from tests.engines.needs import needs, regular

needs("pyelastica")

HEXAGON = regular(6, 0.5, 0.9)


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
@pytest.mark.parametrize("name", ["catenary", "parabola", "tip-only", "hexagon"])
def test_it_is_of_second_order(name):
    case = Case(profile=HEXAGON) if name == "hexagon" else named_case(name)
    coarse, fine = (off(case, n, 15) for n in (10, 20))
    assert coarse.max() < 3e-2
    assert fine.max() < 1e-2
    assert np.log2(coarse.max() / fine.max()) > 1.5


@pytest.mark.parametrize("profile", [circle(1.0, (0.0, 0.4)), HEXAGON], ids=["circle", "hexagon"])
def test_contact_forces_are_the_gradient_of_one_energy(profile):
    """Their derivatives are symmetric, and change smoothly, whichever elements touch."""
    from engines.pyelastica.contact import POINTS, STIFFNESS, Arcs, press, push

    arcs, count, touched = Arcs.of(Case(profile=profile)), 6, 0

    def pushed(nodes: np.ndarray) -> np.ndarray:
        points, outer = np.zeros((5, count, POINTS)), np.zeros((2, count + 1))
        press(nodes, 0.05, arcs, points)
        push(outer, points)
        return outer.ravel() / (0.05 * STIFFNESS)

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
        touched += bool(slopes.any())
        # Gauss's rule is right to some percent where curvature jumps within an element.
        assert np.abs(slopes - slopes.T).max() < (1e-5 if profile is not HEXAGON else 0.05)
    assert touched > 100


def test_it_lies_on_edges_and_jumps_over_corners():
    """Past a hexagon of which nothing is level: where a contact of nodes and elements failed."""
    case = Case(profile=HEXAGON)
    assert off(case, 10, 15).max() < 1e-2


def any_polygon(seed: int) -> Case:
    """Corners on a turned ellipse."""
    random = np.random.default_rng(seed)
    turn = random.uniform(0, 2 * np.pi) + np.sort(random.uniform(0, 2 * np.pi, 6))
    corners = random.uniform(0.3, 1.0, 2) * np.column_stack([np.cos(turn), np.sin(turn)])
    corners[:, 1] += random.uniform(0.3, 0.7) - corners[:, 1].min()
    return Case(Beam(radius=random.uniform(0.002, 0.01)), polygon(corners))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_polygons_let_it_go_where_the_closed_form_says(seed):
    assert off(any_polygon(seed), 20, 15).max() < 1e-2


@pytest.mark.slow
def test_a_snap_off_stays_when_the_way_down_is_refined(monkeypatch):
    from engines.pyelastica import rod

    engine, case = find_engine("pyelastica"), Case(profile=HEXAGON, sweep=Sweep(stations=15))
    coarse = engine.sweep(case, Settings(segments=10)).snap_off
    for name, value in {"_TURN": 0.01, "_NEAR": 1e-5, "_DRAG": 1.0, "_ITERATIONS": 1000}.items():
        monkeypatch.setattr(rod, name, value)
    assert abs(engine.sweep(case, Settings(segments=10)).snap_off - coarse) < 1e-5


def test_what_does_not_come_to_rest_is_not_ok(monkeypatch):
    """Nor a snap-off: one iteration is enough for what is free."""
    from engines.pyelastica import rod

    monkeypatch.setattr(rod, "_ITERATIONS", 1)
    case = replace(named_case("parabola"), sweep=Sweep(stations=8))
    exact, found = solve_sweep(case), find_engine("pyelastica").sweep(case, Settings(segments=10))
    touches = (exact.table["phase"] != "free").to_numpy()
    assert found.snap_off is None
    assert not found.trusted[touches].any()
