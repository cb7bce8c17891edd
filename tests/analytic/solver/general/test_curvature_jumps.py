"""The curve of equilibria goes on where the contour's curvature jumps and no kink says so."""

from dataclasses import replace

from analytic import named_case, solve_sweep, through_points


def test_a_sweep_is_not_lost_past_a_jump_of_curvature():
    """From radius 2 to 0.5: a sixth of the stations was lost when the clamp turned the curve."""
    case = named_case("two-circles")
    points = case.profile.outline(*case.reach, 1000)
    smooth = replace(through_points(points), kinks=())
    for friction in (0.19, 0.197, 0.2):
        found = solve_sweep(replace(case, profile=smooth, friction=friction))
        assert (found.table["status"] == "ok").mean() > 0.99
