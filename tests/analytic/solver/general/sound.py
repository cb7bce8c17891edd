"""What holds of every sweep of a general vibrissa, and what references are held against."""

from pathlib import Path

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, catenary, certify, circle, parabola, reconstruct, solve_sweep

READ = ("force_x", "force_y", "moment_z")
FORCES = {"F_Ax": "force_x", "F_Ay": "force_y", "M_Az": "moment_z"}
PLACES = {"alpha": "contact_angle", "s1": "contact_arc_length", "contact_x": "contact_x"}
EXACT = {"rtol": 1e-11, "atol": 1e-11}
PROFILES = {
    "catenary(0.5,-0.8)": catenary(0.5, -0.8),
    "parabola(0.5,0.5)": parabola(0.5, 0.5),
    "circle(1,(0,0.4))": circle(1.0, lowest=(0, 0.4)),
}


def rows(name):
    """Those of `tests/data`, made by other programs."""
    return pd.read_csv(Path(__file__).parents[3] / "data" / f"{name}.csv")


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
