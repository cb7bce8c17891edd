"""Phases from the clamp: at every noise, past any contour, and where stations are few."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CASE_NAMES,
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Sweep,
    catenary,
    named_case,
    reconstruct,
    relative_noise,
    solve_sweep,
)
from analytic.checks.of_two import touches_twice
from analytic.from_clamp.phases import beyond_one_contact, judge_phases
from tests.analytic.noisy import noisy
from tests.conftest import exact_sweep

# Shares of right stations as published for the default sweeps, less what one seed may miss.
RIGHT = {0.0: 1.0, 1e-4: 0.995, 1e-3: 0.98, 1e-2: 0.9}


@pytest.mark.parametrize("level", RIGHT)
def test_each_phase_is_found_in_spite_of_noise(exact, level):
    """Whether the noise is stated or not; what drowns in it is free, at first contact most."""
    sweep = noisy(exact, relative_noise(exact, level), 1)
    true = exact.table["phase"].to_numpy(str)
    for noise in (None, relative_noise(exact, level)):
        found = reconstruct(sweep, noise)["phase"].to_numpy(str)
        assert (found == true).mean() >= RIGHT[level]
        for phase in ("tip", "tangent"):
            mistaken = ~np.isin(found, (phase, "free"))[true == phase]
            assert not mistaken.size or mistaken.mean() < 0.1


@pytest.mark.parametrize("stations", [2, 5, 8, 12])
@pytest.mark.parametrize("name", CASE_NAMES)
def test_few_stations_are_no_noise(name, stations):
    """Neighbours that differ much are no reason to lose a contact or mistake its phase."""
    exact = solve_sweep(replace(named_case(name), sweep=Sweep(stations=stations)))
    for level in (0.0, 1e-3):
        found = reconstruct(noisy(exact, relative_noise(exact, level), 1))
        touching = (exact.table["phase"] != "free").to_numpy()
        assert found["contact_x"].notna()[touching].all()
        wrong = (found["phase"] != exact.table["phase"])[touching].sum()
        assert wrong <= (1 if level else 0)


def test_nothing_is_found_where_there_is_only_noise(exact):
    rng = np.random.default_rng(5)
    still = {name: 1e-3 * rng.standard_normal(len(exact.table)) for name in CLAMP_READINGS}
    found = reconstruct(replace(exact, table=exact.table.assign(**still)))
    assert (found["phase"] == "free").mean() > 0.99


@pytest.mark.parametrize(
    ("noise", "named"),
    [
        (0.01, "noise = 0.01"),
        ({"force": 0.01}, "noise = 'force'"),
        ({"force_x": -1.0}, "noise of force_x"),
        ({"force_x": float("nan")}, "noise of force_x"),
    ],
)
def test_noise_is_a_standard_deviation_by_column(exact, noise, named):
    with pytest.raises(InputError, match=named):
        reconstruct(exact, noise)


@pytest.mark.parametrize("level", [-0.1, 1.0, float("nan"), True])
def test_relative_noise_is_a_share(exact, level):
    with pytest.raises(InputError, match="noise = "):
        relative_noise(exact, level)


def test_jumps_amid_contact_hide_no_touch_if_free_stations_are_silent():
    """As of a coarse chain past corners: readings jump there, and are nothing without contact."""
    exact = exact_sweep("catenary")
    touching = np.flatnonzero((exact.table["phase"] != "free").to_numpy())
    size = relative_noise(exact, 0.002)
    jumps = np.zeros((3, len(exact.table)))
    jumps[:, touching[5:]] = np.random.default_rng(3).standard_normal((3, len(touching) - 5))
    columns = {n: exact.values(n) + s * j for (n, s), j in zip(size.items(), jumps, strict=True)}
    readings = replace(exact, table=exact.table.assign(**columns))
    assert (judge_phases(readings).phase[touching[:5]] != "free").all()
    # What is stated as noise hides them still.
    assert judge_phases(readings, size).phase[touching[0]] == "free"


def test_zeros_amid_noise_are_no_silence():
    """A sensor's dropouts before the touch, filled with zeros, do not make contacts of noise."""
    exact = exact_sweep("catenary")
    free = (exact.table["phase"] == "free").to_numpy()
    assert free.sum() > 5
    size = relative_noise(exact, 0.01)
    readings = noisy(exact, size, 3)
    table = readings.table
    table.loc[np.flatnonzero(free)[1:4], list(size)] = 0.0
    assert (judge_phases(replace(readings, table=table)).phase[free] == "free").all()


@pytest.mark.parametrize(("noise", "least"), [(1e-5, 30.0), (1e-4, 4.0)])
def test_what_one_contact_does_not_explain(noise, least):
    """Of two contacts a vibrissa that is curved towards the object shows this much."""
    beam = Beam(natural_curvature=0.5)
    exact = solve_sweep(Case(beam, catenary(0.5, -0.8), Sweep(200)))
    stated = relative_noise(exact, noise)
    two = touches_twice(exact.table)
    one = ~two & (exact.table["phase"] != "free").to_numpy()
    draws = np.random.default_rng(1).normal(size=(3, 200))
    table = exact.table.assign(
        **{n: exact.values(n) + stated[n] * x for n, x in zip(CLAMP_READINGS, draws, strict=True)}
    )
    missed = beyond_one_contact(replace(exact, table=table), stated)
    assert np.nanmax(missed[one]) < 4
    assert np.median(missed[two]) > least
