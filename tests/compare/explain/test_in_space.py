"""Mistakes of another simulator in space, each named."""

from dataclasses import replace

import numpy as np
import pytest

from analytic.space import FootPath, SpatialCase, solve_space, sphere
from analytic.space.problem.readings import FOOT, FORCE, MOMENT
from compare import assert_agreement, compare
from compare.align.frames import COMPONENTS, components
from compare.show.spatial_page import spatial_verdict

CASE = SpatialCase(
    body=sphere(1.0, (0.0, 1.4, 0.0)),
    path=FootPath([[1.1, 0.3], [0.2, 0.1]], tangent=(0.2, 1, 0.1), stations=30),
)
EXACT = solve_space(CASE)
FORCES, MOMENTS = EXACT.values(*FORCE), EXACT.values(*MOMENT)
MISTAKES = {
    "flexural rigidity +2.00% off": (1.02 * FORCES, 1.02 * MOMENTS),
    "all components are 1/40 of the reference's: EI": (FORCES / 40, MOMENTS / 40),
    "signs": (-FORCES, -MOMENTS),
    "opposite sign of the moments": (FORCES, -MOMENTS),
    "opposite sign of force_z": (FORCES * [1, 1, -1], MOMENTS),
    "moment_y stays at zero": (FORCES, MOMENTS * [1, 0, 1]),
    "in the clamp's frame": np.split(np.column_stack([*components(EXACT, "clamp").values()]), 2, 1),
    "world's origin": (FORCES, MOMENTS + np.cross(EXACT.values(*FOOT), FORCES)),
    "x, -z, y of": (FORCES[:, [0, 2, 1]] * [1, -1, 1], MOMENTS[:, [0, 2, 1]] * [1, -1, 1]),
    "x, y, -z of": (FORCES * [1, 1, -1], MOMENTS * [-1, -1, 1]),
    "moments in another unit": (FORCES, 1e3 * MOMENTS),
    "twists the vibrissa": (FORCES, MOMENTS + 0.05 * np.abs(MOMENTS).max() * np.array([0, 1, 0])),
}


@pytest.mark.parametrize("said", MISTAKES)
def test_a_mistake_is_named(said):
    columns = zip(COMPONENTS, np.hstack(MISTAKES[said]).T, strict=True)
    mine = replace(EXACT, table=EXACT.table.assign(**dict(columns)), source="mine")
    found = compare(EXACT, mine)
    assert said in found.likely
    assert found.likely in str(found)
    assert spatial_verdict(found).why
    with pytest.raises(AssertionError, match="likely: "):
        assert_agreement(EXACT, mine)


def test_noise_is_named_where_none_is_stated():
    noise = 0.01 * np.random.default_rng(1).standard_normal((30, 6))
    columns = zip(COMPONENTS, (np.hstack([FORCES, MOMENTS]) + noise).T, strict=True)
    found = compare(EXACT, replace(EXACT, table=EXACT.table.assign(**dict(columns))))
    assert found.likely.startswith("noise: ")


def test_a_fault_of_the_sweep_is_no_such_mistake():
    softer = solve_space(replace(CASE, body=sphere(1.0, (0.0, 1.41, 0.0))))
    assert compare(EXACT, replace(softer, source="mine")).likely is None
    assert compare(EXACT, EXACT).likely is None


PAST = solve_space(replace(CASE, path=FootPath([[1.3, 0.3], [-1.5, 0.3]], stations=100)))
LATE = np.arange(100) - np.flatnonzero(PAST.touching)[-1]  # stations after the last in contact
SWING = np.exp(-LATE / 8) * np.cos(1.3 * LATE) * (LATE > 0)


@pytest.mark.parametrize(
    ("off", "said"),
    [
        (SWING, "ringing: the released vibrissa swings"),
        (1.0 * (LATE > 0), "no rest: "),
        *((1.0 * (at == LATE), "single stations: 1 of ") for at in (-70, -20, 0, 1, 10)),
    ],
)
def test_what_is_off_at_some_stations_alone_is_found_with_contact_or_without(off, said):
    """Without contact none was looked at: with 30 % it agreed."""
    columns = {n: PAST.values(n) + 0.3 * np.abs(PAST.values(n)).max() * off for n in FORCE}
    found = compare(PAST, replace(PAST, table=PAST.table.assign(**columns), source="mine"))
    assert found.likely.startswith(said)
    assert {one.name for one in found.exceeded} >= {*FORCE[:2]}
    assert not found.agrees
