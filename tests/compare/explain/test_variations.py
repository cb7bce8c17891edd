"""The exact sweep with one quantity of the physics changed: which way, and by how much."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Beam, Case, Sweep, named_case, solve_sweep
from compare.explain.variations import STEP, variations

LENGTH = 0.05
PARABOLA = named_case("parabola")
CASE = Case(
    Beam(LENGTH, 2e-6, 2.5e-4, natural_curvature=-0.1 / LENGTH, tip_radius=2e-4),
    PARABOLA.profile.scaled(LENGTH),
    Sweep(40),
    clamp_stiffness=20 * 2e-6 / LENGTH,
    friction=0.1,
)


@pytest.fixture(scope="module", params=["left", "right"])
def case(request):
    if request.param == "left":
        return CASE
    return CASE.mirrored()


@pytest.fixture(scope="module")
def found(case):
    return variations(case)


def by_hand(case):
    """The same by other means: what is larger by a thousandth, and of what unit."""
    beam, length = case.beam, case.beam.length
    softer = 1 / (1 / case.clamp_stiffness + 1e-3 * length / beam.base_rigidity)
    first, last = case.foot_x[[0, -1]].tolist()
    shift = 1e-3 * length
    return {
        "flexural_rigidity": replace(case, beam=beam.scaled(rigidity=1.001)),
        "length": replace(case, beam=beam.scaled(length=1.001)),
        "radius": replace(case, beam=replace(beam, radius=1.001 * beam.radius)),
        "foot_x": replace(case, sweep=replace(case.sweep, start=first + shift, stop=last + shift)),
        "friction": replace(case, friction=case.friction + 1e-3),
        "clamp_compliance": replace(case, clamp_stiffness=softer),
        "natural_curvature": replace(
            case, beam=replace(beam, natural_curvature=beam.natural_curvature + 1e-3 / length)
        ),
        "clamp_angle": replace(case, clamp_angle=case.clamp_angle + 1e-3),
        "tip_radius": replace(case, beam=replace(beam, tip_radius=1.001 * beam.tip_radius)),
    }


@pytest.mark.slow
def test_each_is_larger_by_a_thousandth_of_its_unit(case, found):
    wanted = by_hand(case)
    assert STEP == 1e-3
    assert list(found) == list(wanted)
    first, last = case.foot_x[[0, -1]].tolist()
    same = replace(case.sweep, start=first, stop=last)
    exact = solve_sweep(case)
    for name, varied in wanted.items():
        swept = solve_sweep(varied if name == "foot_x" else replace(varied, sweep=same))
        for reading in CLAMP_READINGS:
            true, seen = (x.values(reading) - exact.values(reading) for x in (swept, found[name]))
            known = np.isfinite(true) & np.isfinite(seen)
            assert known.sum() > 20
            # Two of them are the opposite of the opposite change.
            apart = np.quantile(np.abs(true - seen)[known], 0.8)
            assert apart < 5e-3 * np.abs(true[known]).max()


@pytest.mark.slow
def test_a_plain_vibrissa_and_one_that_varies_have_no_more_than_they_can():
    plain = replace(PARABOLA, sweep=Sweep(20))
    assert "tip_radius" in variations(plain)
    varying = Beam(1, lambda s: 1 - 0.3 * s, natural_curvature=lambda s: -0.2 * s)
    found = variations(replace(plain, beam=varying))
    assert "tip_radius" not in found
    assert np.isfinite(found["natural_curvature"].values("force_y")).sum() > 10
