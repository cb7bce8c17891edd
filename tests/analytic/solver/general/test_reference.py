"""Every reference row of a vibrissa with friction, elastic clamp or constant natural curvature."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic import Beam, catenary, parabola, solve_contact
from analytic.problem.support import Support
from analytic.problem.table import as_table
from analytic.solver.columns import Units, to_columns
from analytic.solver.general.contacts import contacts
from analytic.solver.general.states import Vibrissa

ROWS = pd.read_csv(Path(__file__).parents[3] / "data" / "general_vibrissa.csv")
PROFILES = {"g1": catenary(0.5, -0.8), "g2": parabola(0.5, 0.5)}
COLUMN_OF = {
    "s1": "contact_arc_length",
    "x0": "foot_x",
    "F_Ax": "force_x",
    "F_Ay": "force_y",
    "M_Az": "moment_z",
}
VARIANTS = {  # friction, clamp stiffness, natural curvature, radius
    "friction+0.2": (0.2, np.inf, 0.0, 0.0),
    "friction-0.2": (-0.2, np.inf, 0.0, 0.0),
    "friction+0.2-thick": (0.2, np.inf, 0.0, 0.005),
    "spring-5": (0.0, 5.0, 0.0, 0.0),
    "curved+0.3": (0.0, np.inf, 0.3, 0.0),
}
RELATIVE, RESIDUAL = 1e-12, 1e-13  # the second is what the references themselves miss


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("profile", PROFILES)
def test_references(variant, profile):
    friction, stiffness, natural, radius = VARIANTS[variant]
    rows = ROWS.query("variant == @variant and profile == @profile")
    # At eta = 1 to rounding a straight vibrissa just touches: f is that rounding's square root.
    rows = rows[rows["f"] > 1e-6]
    assert len(rows) >= 5
    beam = Beam(radius=radius, natural_curvature=natural)
    alpha = np.deg2rad(rows["alpha_deg"].to_numpy(dtype=float))
    states = contacts(
        PROFILES[profile].offset(radius), alpha, Vibrissa.of(beam, Support(stiffness, friction))
    )
    # The references do not ask what else of the vibrissa touches; only one that is curved may.
    found = as_table(to_columns(states, Units.of(beam))).set_index(rows.index)
    assert (found["status"] == "ok").all()
    public = solve_contact(
        PROFILES[profile], alpha, beam, clamp_stiffness=stiffness, friction=friction
    )
    public.index = rows.index
    ok = public["status"] == "ok"
    assert ok.all() or natural != 0
    pd.testing.assert_frame_equal(public[ok], found[ok])
    assert list(found["phase"].map({"tip": "A", "tangent": "B"})) == list(rows["phase"])
    for reference, column in COLUMN_OF.items():
        np.testing.assert_allclose(found[column], rows[reference], RELATIVE, RESIDUAL)
    slope = found["tip_angle"] - natural * (1 - found["contact_arc_length"])
    np.testing.assert_allclose(slope, rows["phi1"], RELATIVE, RESIDUAL)
    turned = np.pi / 2 - found["moment_z"] / stiffness
    np.testing.assert_allclose(turned, rows["phi0"], RELATIVE, RESIDUAL)
    force = np.hypot(found["force_x"], found["force_y"]) / np.hypot(1, friction)
    np.testing.assert_allclose(force, rows["f"], RELATIVE, RESIDUAL)
