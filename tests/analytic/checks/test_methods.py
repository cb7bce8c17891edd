"""The closed forms against routes that share nothing with them."""

import numpy as np
import pytest

from analytic import Beam, Readings, catenary, certify, parabola, solve_contact, solve_sweep
from analytic.checks import boundary_value_problem, tip_angle_by_quadrature, tip_angle_by_shooting

THIN = Beam(radius=0.0)
CONTACTS = [
    *((catenary(0.5, -0.8), np.deg2rad(a)) for a in (34, 20, 0, -10, -16, -24, -30)),
    *((parabola(0.5, 0.5), np.deg2rad(a)) for a in (40, 30, 5, -20)),
]


@pytest.mark.parametrize(("profile", "alpha"), CONTACTS)
def test_boundary_value_problem(profile, alpha):
    """Collocation at a tolerance of 1e-10: observed 2e-12 in the readings."""
    row = solve_contact(profile, [alpha], THIN).iloc[0]
    found = boundary_value_problem(alpha, row["contact_y"], row["phase"] == "tangent")
    assert found.moment == pytest.approx(row["moment_z"], rel=1e-10)
    assert found.force * np.cos(alpha) == pytest.approx(row["force_y"], rel=1e-10)
    assert found.reach == pytest.approx(row["contact_x"] - row["foot_x"], abs=1e-10)
    assert found.arc_length == pytest.approx(row["contact_arc_length"], rel=1e-10)
    assert found.slope == pytest.approx(row["tip_angle"], abs=1e-10)


@pytest.mark.parametrize("method", [tip_angle_by_quadrature, tip_angle_by_shooting])
@pytest.mark.parametrize(("profile", "alpha"), CONTACTS)
def test_the_papers_two_ways(method, profile, alpha):
    """Eq. 12 and section 3.1.2, with quadrature good to 1e-12."""
    row = solve_contact(profile, [alpha], THIN).iloc[0]
    if row["phase"] == "tip":
        assert method(alpha, row["contact_y"]) == pytest.approx(row["tip_angle"], abs=1e-11)


def test_every_sweep_certifies_itself(exact, case):
    residuals = certify(exact)
    # Runge-Kutta at 1e-13 along the beam; observed 3e-13 and 1e-14.
    assert residuals["residual_boundary"].max() < 2e-12
    assert residuals["residual_moment"].max() < 1e-13
    certified = solve_sweep(case, certified=True)
    assert (certified.table["status"] == "ok").all()
    assert {"residual_boundary", "residual_moment"} < set(certified.table)


@pytest.mark.parametrize(
    "column", ["force_x", "force_y", "moment_z", "contact_x", "contact_arc_length", "contact_angle"]
)
def test_a_wrong_answer_is_found(exact, column):
    """One part in ten thousand off in any column: no station in contact passes."""
    table = exact.table.assign(**{column: exact.table[column] * (1 + 1e-4)})
    residuals = certify(Readings(table, exact.beam)).max(axis=1)
    touching = (exact.table["phase"] != "free") & (exact.table[column].abs() > 1e-2)
    assert (residuals[touching] > 1e-9).all()


def test_a_broken_solver_cannot_hide(case, monkeypatch):
    """Break the spans' lengths by 1e-6: the certificate marks every station in contact."""
    from analytic.solver import equilibria

    def broken(whole):
        def longer(*given):
            found = whole(*given)
            return found._replace(q=found.q * (1 + 1e-6))

        return longer

    for name in ("span", "tangent_span"):
        monkeypatch.setattr(equilibria, name, broken(getattr(equilibria, name)))
    table = solve_sweep(case, certified=True).table
    touching = table["phase"] != "free"
    assert (table.loc[touching, "status"] == "diverged").all()


def test_a_station_without_a_reading_is_not_certified(exact):
    """Its march has no end, and kept the others from coming to theirs."""
    at = int(np.flatnonzero(exact.table["phase"] != "free")[3])
    table = exact.table.copy()
    table.loc[at, "force_x"] = np.nan
    residuals = certify(Readings(table, exact.beam))
    assert residuals.loc[at].isna().all()
    assert residuals["residual_boundary"].drop(index=at).max() < 2e-12
