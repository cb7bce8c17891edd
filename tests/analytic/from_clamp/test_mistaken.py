"""Readings that are no contacts, and which mistake it is; whether noise explains them."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Sweep,
    calibrate,
    circle,
    fit_object,
    named_case,
    reconstruct,
    relative_noise,
    require_beam,
    solve_sweep,
)
from analytic.from_clamp.passes import alike_by_chance
from analytic.from_clamp.reconstruct import doubt
from analytic.problem.named import NAMED_TABLES
from tests.analytic.noisy import noisy
from tests.conftest import exact_sweep

RIG = Case(Beam(0.06, 5e-6, 0.2e-3), circle(0.03, lowest=(0.004, 0.025)), Sweep(150))
FORCES = ("force_x", "force_y")


def mistaken(readings, **factors):
    columns = {name: factor * readings.values(name) for name, factor in factors.items()}
    return replace(readings, table=readings.table.assign(**columns))


@pytest.fixture(scope="module")
def rig():
    exact = solve_sweep(RIG)
    sensed = replace(exact, table=exact.table[["foot_x", *FORCES, "moment_z"]])
    return noisy(sensed, relative_noise(exact, 0.003), 7)


@pytest.mark.parametrize(
    ("factors", "likely"),
    [
        (dict.fromkeys(FORCES, 1e3), r"unit of both forces \(1000 times too large\)"),
        (dict.fromkeys((*FORCES, "moment_z"), 9.80665), r"flexural rigidity \(9.807 times"),
        (dict.fromkeys((*FORCES, "moment_z"), -1.0), "likely .*all signs"),
        (dict.fromkeys(FORCES, -1.0), "likely the signs of force_x and force_y or the signs of"),
        # A force that is made large enough is of a tip, whatever the other one is: alone it is
        # named if nothing else explains the readings.
        ({"force_y": 9.80665}, r"likely the unit of force_y \(9.807 times too large\)$"),
        # It was the unit of both: forces without a size are of a vibrissa next to unloaded.
        ({"force_y": 1e-3}, r"likely the unit of force_y \(1000 times too small\)$"),
        ({"moment_z": 1e-3}, r"likely the unit of moment_z \(1000 times too small\)$"),
        # By kgf, 9.807, it is nearly as well, and was called so.
        ({"moment_z": 10.0}, r"likely the unit of moment_z \(10 times too large\)$"),
    ],
)
def test_readings_of_no_such_vibrissa_are_refused_with_the_likely_mistake(rig, factors, likely):
    wrong = mistaken(rig, **factors)
    with pytest.raises(InputError, match=f"units and signs of .*{likely}"):
        require_beam(reconstruct(wrong), wrong)


def test_swapped_forces_are_named(rig):
    x, y = (rig.values(name) for name in FORCES)
    wrong = replace(rig, table=rig.table.assign(force_x=y, force_y=x))
    with pytest.raises(InputError, match="likely force_x and force_y, swapped"):
        require_beam(reconstruct(wrong), wrong)


@pytest.mark.parametrize(
    ("factors", "likely"),
    [
        (dict.fromkeys(FORCES, 1e-3), "likely the unit of both forces (1000 times too small)"),
        pytest.param(
            dict.fromkeys((*FORCES, "moment_z"), -1.0),
            "all signs (the vibrissa's action",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            {"moment_z": 1e3},
            "likely the unit of moment_z (1000 times too large)",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_calibration_that_is_refused_names_the_mistake(rig, factors, likely):
    """Of a vibrissa whose rigidity is to be found, and is a tenth off what the case says."""
    with pytest.raises(InputError, match=re.escape(likely)):
        calibrate(mistaken(rig, **factors), replace(RIG, beam=Beam(0.06, 5.5e-6, 0.2e-3)))


def test_a_moment_in_another_unit_is_no_force():
    """Of an unknown EI it was "force_x and moment_z, swapped": so large a force is of a tip."""
    exact = solve_sweep(Case(Beam(), circle(0.73, lowest=(0.22, 0.44)), Sweep(150)))
    read = noisy(exact, relative_noise(exact, 0.005), 7)
    wrong = replace(mistaken(read, moment_z=1e3), beam=Beam(1.0, 1.1))
    assert not any("swapped" in one for one in doubt(reconstruct(wrong), wrong).mistakes)


@pytest.mark.parametrize("name", ["moment_z", "force_x"])
def test_a_wrong_sign_is_named(rig, name):
    """Two thirds of its stations might be of a vibrissa that bends to the other side."""
    wrong = mistaken(rig, **{name: -1.0})
    said = doubt(reconstruct(wrong), wrong)
    assert said.mistakes == ["the sign of moment_z", "the sign of force_x"]
    assert str(said).endswith("likely the sign of moment_z or the sign of force_x")


def test_a_contact_at_the_tip_is_at_the_tip(rig):
    """Forces a thousand times too large put all of them next to the clamp."""
    found = reconstruct(mistaken(rig, **dict.fromkeys(FORCES, 1e3)))
    assert not (found["phase"] == "tip").any()
    neither = found["status"] == "neither phase"
    assert neither.sum() > 80
    assert (found["phase"][neither] == "unexplained").all()
    assert found.loc[neither, ["contact_x", "contact_arc_length"]].isna().all(axis=None)


@pytest.mark.parametrize("level", [0.0, 0.001, 0.01, 0.03])
@pytest.mark.parametrize("name", [name for name in NAMED_TABLES if name != "whisker"])
def test_good_readings_are_not_doubted(name, level):
    exact = exact_sweep(name)
    readings = noisy(exact, relative_noise(exact, level), 5)
    found = reconstruct(readings)
    assert not (found["status"] == "neither phase").any()
    assert doubt(found, readings) is None
    require_beam(found, readings)


def test_an_unstated_friction_leaves_the_contacts():
    """The paper's vibrissa is taken for one that rubs: its points stay, none is called a tip's."""
    exact = solve_sweep(replace(named_case("catenary"), friction=0.5))
    found = reconstruct(exact.with_friction(0.0))
    touching = (exact.table["phase"] != "free").to_numpy()
    assert (found["status"][touching] == "ok").all()
    tip = found["phase"] == "tip"
    assert (found["contact_arc_length"][tip] > 0.89).all()


LEANING = Case(Beam(), circle(0.25, (0.05, 0.8)), Sweep(260), clamp_angle=np.radians(2.0))
UPRIGHT = replace(LEANING, clamp_angle=0.0)
UNKNOWNS = ["flexural_rigidity", "clamp_angle"]


def passes(case, rng, memory, count=4, level=0.01):
    """Passes whose noise of 1 % remembers, as a rig's: what is free shows it."""
    exact = solve_sweep(case)
    size = relative_noise(exact, level)
    exact = replace(exact, provenance={**exact.provenance, "free_noise": size})
    return [noisy(exact, size, rng, memory) for _ in range(count)]


@pytest.mark.parametrize("memory", [pytest.param(0.0, marks=pytest.mark.slow), 0.9])
def test_noise_that_remembers_is_no_fault_of_the_case(memory):
    """It left 3.2 times what shows from row to row, and a right case was refused."""
    found = calibrate(passes(LEANING, np.random.default_rng(3), memory), UPRIGHT, UNKNOWNS)
    assert found.explains
    assert found.misfit == pytest.approx(1, abs=0.15)
    angle = found.found["clamp_angle"]
    assert angle.lowest < LEANING.clamp_angle < angle.highest


def test_files_without_a_rigs_word_show_their_noise_where_nothing_touches():
    """Of AR(0.9) six of six right rigs were refused: it left 4 times what jumps between rows."""
    first, last = UPRIGHT.foot_x[[0, -1]]
    far = replace(UPRIGHT, sweep=Sweep(400, start=first + 0.5, stop=last - 0.3))
    seen = passes(far, np.random.default_rng(7), 0.9, 1)[0]
    seen.provenance.pop("free_noise")
    assert calibrate(seen, UPRIGHT).explains
    assert not calibrate(seen, replace(UPRIGHT, profile=circle(0.3, (0.05, 0.75)))).explains


@pytest.mark.slow
@pytest.mark.parametrize("memory", [0.0, 0.9])
def test_another_object_is_no_noise_that_remembers(memory):
    wide = replace(UPRIGHT, profile=circle(0.3, (0.05, 0.75)))
    for count in (1, 4):
        seen = passes(UPRIGHT, np.random.default_rng(4), memory, count)
        assert not calibrate(seen, wide).explains


def test_what_all_passes_leave_alike_is_no_noise():
    """A radius 3 % off leaves no more than the noise at a station, and a rigidity 1 % off."""
    other = replace(UPRIGHT, profile=circle(0.2575, (0.05, 0.8)))
    found = calibrate(passes(UPRIGHT, np.random.default_rng(5), 0.0), other)
    rigidity = found.found["flexural_rigidity"]
    assert not rigidity.lowest < 1 < rigidity.highest
    assert not found.misfit_shows
    assert found.passes.leave_alike
    assert not found.explains


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 2])
def test_what_remembers_longer_than_a_pass_may_be_no_noise(count):
    """The same object past one pass: it left 1.1 times the noise, and was called right."""
    case = replace(UPRIGHT, sweep=Sweep(600))
    seen = passes(case, np.random.default_rng(1), 0.0, count)
    assert calibrate(seen, case).explains
    found = calibrate(seen, replace(case, profile=circle(0.2575, (0.05, 0.8))))
    assert not found.misfit_shows
    assert not found.explains
    assert any("longer than a pass" in said for said in found.noise.said(CLAMP_READINGS))


@pytest.mark.slow
@pytest.mark.parametrize("period", [2.4, 7.3])
def test_hum_beside_a_stated_noise_is_noise(period):
    """A circle was called none: of 1 % of noise beside 2 % of hum 1.7 times was left."""
    (one,) = passes(UPRIGHT, np.random.default_rng(7), 0.0, 1)
    size = relative_noise(one, 0.01)
    wave = np.sin(2 * np.pi * np.arange(len(one.table)) / period)
    columns = {name: one.values(name) + 2 * x * wave for name, x in size.items()}
    found = fit_object(replace(one, table=one.table.assign(**columns)), "circle", size)
    assert found.noise.hum == pytest.approx(period, rel=1e-2)
    assert found.misfit == pytest.approx(1, abs=0.1)
    assert found.explains


@pytest.mark.parametrize(("memory", "size"), [(0.0, 0.5), (0.9, 1.5)])
def test_passes_of_noise_leave_the_same_by_chance_alone(memory, size):
    """With a zero of its own each: of 200 sets 10 are below 0.05; that it is 25 is no chance.

    What is in common is noticed nearly always if it is as large as half of white noise.
    """
    rng, passes, rows = np.random.default_rng(1), 5, 300
    along = np.tile(np.linspace(-1, 1, rows), passes)
    drift = np.concatenate([x[:, None, None] * np.eye(3) for x in (np.ones_like(along), along)], 2)
    by_number = np.repeat(np.exp(along)[:, None, None], 3, axis=1)
    wrong = size * np.sin(4 * along)[:, None]
    low, noticed = 0, 0
    for _ in range(200):
        noise = lfilter([1], [1, -memory], rng.standard_normal((passes, rows + 300, 3)), axis=1)
        noise = noise[:, 300:] * np.sqrt(1 - memory**2) + 0.3 * rng.standard_normal((passes, 1, 3))
        found = [
            alike_by_chance(noise.reshape(-1, 3) + x, by_number, drift, along, passes * [rows])
            for x in (0, wrong)
        ]
        low, noticed = low + (found[0] < 0.05), noticed + (found[1] < 1e-3)
    assert low < 25
    assert noticed > 180


@pytest.mark.trial
def test_passes_that_differ_by_noise_alone_are_called_so():
    """The chi square of 200 sets of four passes has the mean of its degrees of freedom.

    It is 2.0 if nothing says that the zeros are exact: zero and slope count as known to 0.1 %.
    """
    rng, found = np.random.default_rng(9), []
    for _ in range(200):
        some = passes(UPRIGHT, rng, 0.0)
        known = {name: 1e-3 * size for name, size in some[0].provenance["free_noise"].items()}
        exact = [replace(x, provenance=x.provenance | {"zero_uncertainty": known}) for x in some]
        found.append(calibrate(exact, UPRIGHT).passes)
    assert np.mean([one.chi_square for one in found]) == pytest.approx(3, abs=0.6)
    assert sum(one.consistent and not one.leave_alike for one in found) >= 194


@pytest.mark.slow
def test_a_sign_that_hides_the_numbers_is_named():
    (one,) = passes(UPRIGHT, np.random.default_rng(6), 0.0, 1)
    other = replace(one, table=one.table.assign(force_y=-one.values("force_y")))
    with pytest.raises(InputError, match="likely the sign of force_y"):
        calibrate(other, UPRIGHT, ["flexural_rigidity", "offset"])


def test_passes_that_cannot_be_one_rigs_are_named():
    (one,) = passes(UPRIGHT, np.random.default_rng(6), 0.0, 1)
    back = replace(one, table=one.table.iloc[::-1].reset_index(drop=True))
    with pytest.raises(InputError, match="moment of pass 1 is that of a sweep to the other side"):
        calibrate(back, UPRIGHT)
    with pytest.raises(InputError, match=r"vibrissae = L = 1, EI = 1, .* and L = 2, EI = 1, r"):
        calibrate([one, replace(one, beam=Beam(2.0))], UPRIGHT)
