"""The verdict leads with what matters, and says nothing of what is not known."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Beam, Case, Readings, circle, solve_sweep
from compare import Tolerances, compare
from compare.sense.noise import with_noise
from compare.show.verdict import verdict
from tests.compare.synthetic import changed, scaled, solved, unread
from tests.conftest import exact_sweep


def words(found) -> str:
    """All that is said: in the terminal's short form, and in the verdict."""
    return " ".join([*found.lines(), *found.failures, found.likely or "", verdict(found)])


def test_readings_come_before_phases_and_events():
    """Less wrong than a snap-off that is missing: it follows from the readings."""
    ends = replace(scaled(solved(), force_y=1.03), provenance={})
    short = replace(ends, table=ends.table.iloc[:100].reset_index(drop=True))
    found = compare(solved(), short)
    assert {"force_y", "snap_off"} <= {one.name for one in found.exceeded}
    assert found.worst.name == "force_y"


@pytest.mark.parametrize(
    ("made", "leads"),
    [(unread, "contact"), (lambda sweep: changed(sweep, foot_x=-sweep.table["foot_x"],
                                                 moment_z=-sweep.table["moment_z"]), "direction"),
     (lambda sweep: scaled(sweep, force_y=1.03), "force_y")],
)  # fmt: skip
def test_what_makes_all_else_wrong_comes_before_all(made, leads):
    """Else what is exceeded most does."""
    found = compare(solved(), made(solved()))
    assert found.worst.name == leads
    if leads == "force_y":
        assert found.worst.excess == max(one.excess for one in found.exceeded)
        assert ": force_y (" in verdict(found)


def of_length(size: float, spoil) -> str:
    """What is said of a spoilt sweep of a vibrissa of some length."""
    case = Case(Beam(size, 2e-6, 0.005 * size), circle(0.8 * size, (0.0, 0.4 * size)))
    exact = solve_sweep(case)
    return words(compare(exact, spoil(exact, size)))


@pytest.mark.parametrize(
    "spoil",
    [
        pytest.param(
            lambda exact, size: changed(exact, foot_x=exact.table["foot_x"] + 0.02 * size),
            marks=pytest.mark.slow,
        ),
        lambda exact, size: changed(exact, rows=slice(0, 120)),
        lambda exact, size: changed(
            exact,
            force_y=exact.table["force_y"] * np.where(np.arange(200) % 50 == 20, 1.5, 1.0),
            status=np.repeat(["ok", "lost"], 100),
        ),
    ],
)
def test_lengths_are_in_units_of_the_vibrissa(spoil):
    """In one unit all through, whatever the case's: the same is said of a vibrissa of 50 mm."""
    assert of_length(0.05, spoil) == of_length(1.0, spoil)


def test_a_comparison_is_neither_true_nor_false():
    """``assert compare(...)`` held, whatever was found."""
    with pytest.raises(TypeError, match=r"take `.agrees`"):
        assert compare(solved(), solved())


def test_the_stations_that_figures_rest_on_are_said():
    wide = Tolerances(rms=1e-3, snap_off_window=0.05)
    found = compare(solved(), scaled(solved(), force_y=1.03), wide)
    rest_on = found.disagreement["force_y"].stations
    assert rest_on < found.alignment.counts["compared"]
    assert f"{rest_on} of {len(solved().table)} stations" in next(found.lines())
    assert f"{rest_on} stations" in verdict(found)


def test_a_phase_that_noise_alone_makes_is_no_failure():
    """Past a circle on which the contact stays at the tip: one station of another phase."""
    exact = solve_sweep(Case(profile=circle(1.0, (0, 0.65))))
    made = 0
    for seed in range(6, 10):
        noisy = with_noise(exact, dict.fromkeys(CLAMP_READINGS, 3e-3), seed)
        found = compare(exact, Readings(noisy.table[["foot_x", *CLAMP_READINGS]]), noise=3e-3)
        made += found.transitions["phase_b_end"].candidate is not None
        assert not any(one.name.startswith("phase_b") for one in found.exceeded)
    assert made


@pytest.mark.parametrize("side", ["reference", "candidate"])
@pytest.mark.parametrize("count", [1, 20])
def test_a_stretch_of_either_side_that_is_not_trusted_is_said(side, count):
    """Of a single station, too, with which the sweeps agree."""
    exact, here = exact_sweep("catenary"), slice(90, 90 + count)
    status = np.full(200, "ok", dtype=object)
    status[here] = "touches again"
    sweeps = {"reference": exact, "candidate": exact}
    sweeps[side] = changed(exact, status=status)
    at = exact.values("foot_x")[here]
    found = compare(**sweeps)
    assert f"{count} touches again, foot_x {at[0]:.4g} to {at[-1]:.4g} L" in words(found)
    assert found.agrees or count > 1
    # Where it is a failure already, the candidate's is not said twice.
    assert sum("touches again" in line for line in (*found.failures, *found.remarks)) == 1


@pytest.mark.parametrize("side", ["reference", "candidate"])
def test_an_event_in_a_stretch_without_trust_does_not_lead(side):
    """What is not known there is no event that is missing: the stretch itself is what matters."""
    exact = exact_sweep("catenary")
    sweeps = {"reference": exact, "candidate": exact}
    sweeps[side] = changed(exact, status=np.where(np.arange(200) < 60, "ok", "touches again"))
    found = compare(**sweeps)
    missing = next(one for one in found.exceeded if one.name == "phase_b_end")
    assert f"where stations of the {side} are not to be trusted" in missing.found
    assert found.worst.name == ("stations" if side == "candidate" else "phase_b_end")
