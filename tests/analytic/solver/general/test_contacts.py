"""Contacts at given points: every reference row of a general vibrissa, and those of its sweep."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic import Beam, Sweep, catenary, parabola, solve_contact, solve_sweep
from analytic.problem.case import Case
from analytic.problem.support import Support
from analytic.problem.table import as_table
from analytic.solver.contact import contacts
from analytic.solver.general.columns import Units, to_columns
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
VARIANTS = {  # the beam, and what holds it
    "friction+0.2": (Beam(radius=0.0), {"friction": 0.2}),
    "friction-0.2": (Beam(radius=0.0), {"friction": -0.2}),
    "friction+0.2-thick": (Beam(), {"friction": 0.2}),
    "spring-5": (Beam(radius=0.0), {"clamp_stiffness": 5.0}),
    "curved+0.3": (Beam(radius=0.0, natural_curvature=0.3), {}),
    "cone-0.7": (Beam(flexural_rigidity=lambda s: (1 - 0.3 * s) ** 4, radius=0), {}),
    "cone-0.2": (Beam(flexural_rigidity=lambda s: (1 - 0.8 * s) ** 4, radius=0), {}),
    "graded-0.5": (Beam(flexural_rigidity=lambda s: 1 - s / 2, radius=0), {}),
    "curved-linear": (Beam(natural_curvature=lambda s: -0.8 * s, radius=0), {}),
    "all": (
        Beam(flexural_rigidity=lambda s: (1 - 0.4 * s) ** 4, natural_curvature=lambda s: -0.4 * s),
        {"clamp_stiffness": 8.0, "friction": 0.15},
    ),
}
RELATIVE, RESIDUAL = 1e-12, 1e-13  # the second is what the references themselves miss


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("profile", ["g1", pytest.param("g2", marks=pytest.mark.slow)])
def test_references(variant, profile):
    beam, held = VARIANTS[variant]
    stiffness, friction = held.get("clamp_stiffness", np.inf), held.get("friction", 0.0)
    rows = ROWS.query("variant == @variant and profile == @profile")
    # At eta = 1 to rounding a straight vibrissa just touches: f is that rounding's square root.
    rows = rows[rows["f"] > 1e-6]
    assert len(rows) >= 5
    alpha = np.deg2rad(rows["alpha_deg"].to_numpy(dtype=float))
    contour = PROFILES[profile].offset(beam.unloaded.tip_radius)
    states = contacts(contour, alpha, Vibrissa.of(beam, Support(stiffness, friction)))
    # The references do not ask what else of the vibrissa touches; only one that is curved may.
    found = as_table(to_columns(states, Units.of(beam))).set_index(rows.index)
    assert (found["status"] == "ok").all()
    public = solve_contact(PROFILES[profile], alpha, beam, **held)
    public.index = rows.index
    ok = public["status"] == "ok"
    assert ok.all() or variant == "curved+0.3"
    pd.testing.assert_frame_equal(public[ok], found[ok])
    assert list(found["phase"].map({"tip": "A", "tangent": "B"})) == list(rows["phase"])
    for reference, column in COLUMN_OF.items():
        np.testing.assert_allclose(found[column], rows[reference], RELATIVE, RESIDUAL)
    length = found["contact_arc_length"].to_numpy()
    slope = found["tip_angle"] - beam.unloaded.turn_between(length, 1.0)
    np.testing.assert_allclose(slope, rows["phi1"], RELATIVE, RESIDUAL)
    turned = np.pi / 2 - found["moment_z"] / stiffness
    np.testing.assert_allclose(turned, rows["phi0"], RELATIVE, RESIDUAL)
    force = np.hypot(found["force_x"], found["force_y"]) / np.hypot(1, friction)
    np.testing.assert_allclose(force, rows["f"], RELATIVE, RESIDUAL)


COLUMNS = ["foot_x", "force_x", "force_y", "moment_z", "contact_arc_length", "tip_angle"]


@pytest.mark.parametrize(
    ("profile", "beam", "held"),
    [
        (
            parabola(0.7, 0.4),
            Beam(natural_curvature=-0.4),
            {"clamp_stiffness": 6.0, "friction": 0.2},
        ),
        (catenary(0.5, -0.8), Beam(), {"clamp_angle": 0.25, "friction": 0.1}),
        (parabola(0.5, 0.5), Beam(), {"weight": (0.5, -1.0)}),
    ],
)
def test_contacts_are_the_stations_of_the_sweep(profile, beam, held):
    swept = solve_sweep(Case(beam, profile, Sweep(30), **held)).table
    swept = swept[swept["phase"] != "free"].reset_index(drop=True)
    found = solve_contact(profile, swept["contact_angle"], beam, **held)
    # Next to first contact the angle hardly determines the force.
    pd.testing.assert_frame_equal(found[COLUMNS], swept[COLUMNS], rtol=0, atol=1e-9)
    assert list(found["phase"]) == list(swept["phase"])


def test_vibrissa_out_of_reach_has_no_readings():
    found = solve_contact(parabola(0.5, 0.5), [-1.4, 0.1, 1.4], friction=0.3)
    assert list(found["status"]) == ["unreachable", "ok", "unreachable"]
    assert found.loc[[0, 2], ["force_x", "force_y", "moment_z"]].isna().all(axis=None)
