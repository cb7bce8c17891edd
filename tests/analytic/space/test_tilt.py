"""A clamp that leans sideways: the exact slip-off against its limit for small tilts."""

import numpy as np
import pytest

from analytic import Beam, InputError, circle, find_events, named_case, slip_off, solve_contact

CIRCLE = circle(1.0, lowest=(0.0, 0.4))


def test_small_tilts_follow_the_power_of_two_thirds():
    """x0 - x0(0) = (3/2) x0' (X tilt^2/x0')^(1/3), with the planar reach X and rate x0'."""
    place = find_events(CIRCLE).out_of_plane
    at = solve_contact(CIRCLE, [-1e-4, 1e-4])["foot_x"]
    rate = (at[1] - at[0]) / 2e-4
    tilts = np.array([1e-4, 1e-5, 1e-6])
    limit = 1.5 * rate * ((place.contact_x - place.foot_x) * tilts**2 / rate) ** (1 / 3)
    earlier = np.array([slip_off(CIRCLE, tilt) for tilt in tilts]) - place.foot_x
    error = np.abs(earlier / limit - 1)
    assert error[-1] < 1e-3
    # The next term is smaller by alpha, which goes as the same power.
    assert (error[1:] < 0.3 * error[:-1]).all()


def test_leaning_to_either_side_is_the_same_and_more_is_worse(case):
    less, more, other = (slip_off(case.profile, t, case.beam) for t in (1e-3, 1e-2, -1e-2))
    assert other == pytest.approx(more, abs=1e-12)
    assert find_events(case.profile, case.beam).out_of_plane.foot_x < less < more


def test_a_vibrissa_that_leans_much_swings_round_steadily():
    case = named_case("catenary")
    assert slip_off(case.profile, np.radians(2), case.beam) is not None
    assert slip_off(case.profile, np.radians(5), case.beam) is None
    # The curvature of two circles jumps at their lowest point, where the foot is at 0 then.
    assert slip_off(named_case("two-circles").profile, 0.5) == pytest.approx(0.0, abs=1e-9)


def test_places_scale_with_the_beam():
    beam = Beam(50.0, 7.0, 0.25)
    scaled = slip_off(CIRCLE.scaled(50.0), 0.01, beam)
    assert scaled == pytest.approx(50 * slip_off(CIRCLE, 0.01), rel=1e-9)


@pytest.mark.parametrize("tilt", [0.0, 1.0, float("nan")])
def test_refused(tilt):
    with pytest.raises(InputError, match="tilt"):
        slip_off(CIRCLE, tilt)


@pytest.mark.slow
def test_mujoco_slips_off_there():
    """MuJoCo's own motion of a chain on a leaning foot, station by station."""
    from analytic import Case
    from analytic.problem.clamp_path import Pose
    from mujoco_models import Settings
    from mujoco_models.beams.protocol import FOOT
    from mujoco_models.sweep.spatial_walk import GENTLE_STEP
    from mujoco_models.sweep.sweep import set_out
    from mujoco_models.sweep.walk import Walk

    case = Case(profile=CIRCLE)
    settings = Settings(segments=10, contour_points=1600, planar=False)
    model = set_out(case, settings).model
    walk = Walk(model, case, 1e-8)
    tilt = np.radians(1)
    place = slip_off(CIRCLE, tilt)
    for foot_x in np.linspace(0.9, place + 0.02, 30):
        walk.go_to(float(foot_x))
    foot = model.model.body(FOOT).id
    lookout, out = model.lookout, []
    for ahead in (0.01, 0.004, -0.004):
        model.move_clamp(Pose(place + ahead, 0.0, 0.0))
        model.model.body_quat[foot] = [np.cos(tilt / 2), np.sin(tilt / 2), 0, 0]
        for _ in range(10_000):
            moved = model.creep(GENTLE_STEP)
            lookout.follow_contact(model.contacts())
            lookout.watch(lookout.watched | lookout.unwatched())
            if moved < 1e-8:
                break
        model.evaluate()
        assert moved < 1e-8
        contacts = model.contacts()
        out.append(float(contacts.normal[np.argmin(contacts.distance), 0]))
    # On the near side until there, and 4e-3 L farther, which 10 segments and 1,600 facets need not
    # distinguish, on the other one.
    assert all(0.03 < slope < 0.1 for slope in out[:2])
    assert out[2] < -0.5
