"""What holds of every sweep of a general vibrissa."""

import numpy as np

from analytic import CLAMP_READINGS, certify, reconstruct, solve_sweep

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


def assert_confirmed(case, *, integrated, mirrored=1e-12, seen):
    """An integration, the mirror image and the contact seen from the clamp say the same."""
    readings = solve_sweep(case)
    settled = readings.table["status"].isin(["ok", "sticks"]).to_numpy()
    assert certify(readings)[settled].max(axis=None) < integrated
    image = solve_sweep(case.mirrored()).mirrored()
    for name in (*CLAMP_READINGS, "contact_x", "contact_y", "tip_angle", "clamp_angle"):
        if name in readings.table:
            np.testing.assert_allclose(image.values(name), readings.values(name), atol=mirrored)
    touching = settled & readings.table["phase"].ne("free").to_numpy()
    found = reconstruct(readings)
    for name in ("contact_x", "contact_y", "contact_arc_length"):
        apart = found[name] - readings.table[name]
        np.testing.assert_allclose(apart[touching], 0, atol=seen)
    return readings, found, touching
