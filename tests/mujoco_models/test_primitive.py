"""The smooth primitive: no facets, so that nothing hides the beam's order of convergence."""

from functools import cache

import numpy as np
import pytest

from analytic import Beam, Case, InputError, Sweep, circle, ellipse, named_case, solve_sweep
from analytic.problem.readings import CLAMP_READINGS
from compare import compare
from mujoco_models import Settings, available_beams, simulate_sweep

CASES = {
    "circle": Case(profile=circle(1.0, lowest=(0.0, 0.4)), sweep=Sweep(stations=30)),
    "ellipse": Case(profile=ellipse((1.0, 0.5), lowest=(0.0, 0.4)), sweep=Sweep(stations=30)),
}
FLOOR = 5e-5  # rms, relative: what the contacts' softness and the beads' spacing leave


@cache
def errors(name, beam, segments):
    simulated = simulate_sweep(
        CASES[name], Settings(beam=beam, segments=segments, obstacle="primitive")
    )
    assert (simulated.table["status"] == "ok").all()
    found = compare(solve_sweep(CASES[name]), simulated)
    return np.array([found.disagreement[reading].rms for reading in CLAMP_READINGS])


@pytest.mark.parametrize("name", CASES)
def test_agrees_with_the_closed_form(name):
    # Observed at most 5.4e-4, in force_y; the mesh has 1e-3.
    assert (errors(name, "chain", 40) < 8e-4).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("beam", available_beams())
def test_second_order_until_the_floor(beam, name):
    """Single doublings scatter about 2: the beads' spacing is bounded by more than N."""
    segments = np.array([10, 20, 40, 80, 160] if beam == "chain" else [10, 20, 40, 80])
    found = np.array([errors(name, beam, int(n)) for n in segments])
    slopes = -np.polyfit(np.log(segments), np.log(found), 1)[0]
    assert (slopes > 1.8).all(), (found, slopes)
    assert (slopes < 2.4).all(), (found, slopes)
    if beam == "chain":
        assert (found[-1] < FLOOR).all(), found[-1]


@pytest.mark.parametrize("semi_axes", [(1.0, 1.0), (1.0, 0.5), (0.2, 0.7)])
def test_distance_and_curvature_are_those_of_the_contour(semi_axes):
    from mujoco_models.obstacles.primitive import Primitive

    profile = ellipse(semi_axes, lowest=(0.1, 0.4)).scaled(2.0).mirrored()
    case = Case(Beam(length=2.0, radius=0.01), profile)
    obstacle = Primitive.of(case)
    alpha = np.linspace(-1.4, 1.4, 15)
    at = profile.scaled(0.5).at(alpha)
    np.testing.assert_allclose(1 / obstacle.curvature(alpha), at.stretch, rtol=1e-12)
    whole = obstacle.curvature(np.linspace(-np.pi / 2, np.pi / 2, 99))
    assert obstacle.largest_curvature == pytest.approx(whole.max(), rel=1e-12)
    for distance in (-0.01, 1e-4, 0.3):
        outward = distance * np.column_stack([np.sin(alpha), -np.cos(alpha)])
        points = np.column_stack([at.xi, at.eta]) + outward
        for point, slope in zip(points, alpha, strict=True):
            assert obstacle.clearance(point) == pytest.approx((distance, slope), abs=1e-9)
        assert len(obstacle.near(points, distance + 1e-9)) == len(points)


@pytest.mark.parametrize("name", CASES)
def test_distance_is_mujocos(name):
    """The straight vibrissa as it comes near: MuJoCo's distances and normals, and ours."""
    from mujoco_models.beams.kinds import build
    from mujoco_models.model import BeamModel
    from mujoco_models.obstacles.primitive import Primitive

    case = CASES[name]
    beam = build(Settings(segments=4), spacing=0.01)
    model = BeamModel(beam, case.radius, Primitive.of(case), 1e7)
    model.imbalance(case.foot_x[0] - 0.01, np.zeros(4))
    bead, normal, distance = model.contacts()
    assert len(bead) >= 3
    own = [model.obstacle.clearance(point) for point in model.bead_positions(bead)]
    clearance, slope = np.transpose(own)
    np.testing.assert_allclose(distance, clearance - case.radius, atol=1e-12)
    noise = 3 * model.obstacle.normal_noise + 1e-12
    np.testing.assert_allclose(np.arctan2(normal[:, 0], -normal[:, 1]), slope, atol=noise)


@pytest.mark.parametrize(
    "profile", [named_case("catenary").profile, circle(1.0, lowest=(0.0, 0.4)).offset(0.1)]
)
def test_other_contours_are_refused(profile):
    case = Case(profile=profile)
    with pytest.raises(InputError, match="'mesh', or the contour a circle or an ellipse"):
        simulate_sweep(case, Settings(obstacle="primitive"))
