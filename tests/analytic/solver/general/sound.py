"""What holds of every sweep of a general vibrissa."""

from analytic import certify, solve_sweep

READ = ("force_x", "force_y", "moment_z")


def assert_sound(case):
    """Every station that is ok balances, by integration from the clamp; none is lost."""
    readings = solve_sweep(case)
    table = readings.table
    assert set(table["status"]) <= {"ok", "touches again", "sticks"}
    ok = table["status"] == "ok"
    assert table.loc[ok, ["residual_boundary", "residual_moment"]].max(axis=None) < 1e-12
    # 1e-10: the integration errs by 1e-13 times how much an error at the clamp grows.
    assert certify(readings)[ok].max(axis=None) < 1e-10
    return readings
