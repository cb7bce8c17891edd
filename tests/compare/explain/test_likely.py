"""Where a cause begins to be named: slopes by phase, spikes, and two causes that fit alike."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import CubicSpline

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    Readings,
    Sweep,
    circle,
    named_case,
    parabola,
    relative_noise,
    solve_sweep,
)
from compare import Tolerances, compare
from compare.align.offset import without_offset
from compare.explain.causes import physical_faults, sensor_faults, slopes
from compare.explain.fit import Explanation
from compare.explain.likely import likely_cause
from compare.explain.one_or_two import Weigh, best_alone
from compare.judge.allowance import NoiseAllowance
from compare.measure.measurement import measure
from compare.sense.noise import with_noise
from tests.analytic.noisy import noisy
from tests.compare.synthetic import (
    BEAM,
    STATIONS,
    changed,
    mute,
    scaled,
    sensed,
    solved,
    unread,
    untrusted,
)
from tests.conftest import exact_sweep

_UNKNOWN = "beside that the readings disagree, and do not show why"


def named(force_y: np.ndarray, contour: bool = False) -> str | None:
    """The cause of a disagreement in force_y alone, with causes that need the contour or not."""
    exact = solved() if contour else replace(solved(), provenance={})
    found = measure(exact, changed(exact, force_y=force_y), 5e-3)
    return likely_cause(found, Tolerances(), NoiseAllowance())


def test_slopes_are_of_one_phase_each():
    """Up to its last station; a stretch of three has none."""
    x = np.linspace(1.0, -0.5, 14)
    phase = np.repeat(["tip", "tangent", "tip"], [4, 7, 3])
    values = np.stack([np.sin(k * x) + (phase == "tangent") for k in (1, 2, 3)])
    found = slopes(pd.DataFrame({"at": x, "phase": phase}), values)
    for here in (slice(0, 4), slice(4, 11)):
        order = np.argsort(x[here])
        spline = CubicSpline(x[here][order], values[:, here][:, order], axis=-1)
        np.testing.assert_allclose(found[:, here], spline(x[here], 1), rtol=1e-10)
    assert np.isnan(found[:, 11:]).all()


@pytest.mark.slow
def test_a_fault_of_a_small_size_is_its_signature():
    """Solved at that size, and as it acts on the readings. Observed: to 4e-3 of the largest."""
    found = measure(solved(), solved(), 5e-3)
    table, size = found.alignment.table, 1e-4
    scale = np.array([found.disagreement[name].scale for name in CLAMP_READINGS])
    true = np.stack([table[f"{name}_reference"] for name in CLAMP_READINGS]) / scale[:, None]
    faults = [*sensor_faults(true), *physical_faults(found, table, true, scale)]
    assert sum(fault.change is not None for fault in faults) >= 13
    for fault in faults:
        solved_at = fault.change and fault.change(size)
        acted = fault.acts and fault.acts(size, true, table["at"].to_numpy()) - true
        for added in (solved_at, acted):
            if added is not None:  # next to the borders of phases slopes are one-sided
                off = np.nanquantile(np.abs(added - size * fault.signature), 0.9)
                assert off < 1e-2 * size * np.nanmax(np.abs(fault.signature)), fault.text(size)


@pytest.mark.parametrize(
    ("times", "spikes", "single"), [(25, 4, True), (15, 4, False), (25, 7, False)]
)
def test_single_stations_are_few_and_far_off(times, spikes, single):
    """More than twenty times the median, and at most one in twenty: of 110 in contact, five."""
    force = solved().values("force_y").copy()
    touching = np.flatnonzero(solved().table["phase"] != "free")
    error = 1e-4 * np.abs(force).max() * np.where(np.arange(len(force)) // 2 % 2, 1.0, -1.0)
    at = touching[10 : 10 + 8 * spikes : 8]
    error[at] *= times
    force[touching] += error[touching]
    assert str(named(force)).startswith("single stations") == single


@pytest.mark.parametrize("by", [0.03, 0.1, 0.3])
def test_a_contact_that_begins_late_is_named(by):
    """It was nothing, "single stations", or a vibrissa that has to come to rest."""
    exact = exact_sweep("parabola")
    late = exact.values("foot_x") > exact.provenance["events"]["first_contact"] - by
    seen = {n: np.where(late, 0.0, exact.values(n)) for n in CLAMP_READINGS}
    for share in (0.0, 0.3):  # of the load at the station before
        for name in CLAMP_READINGS:
            seen[name][late.sum() - 1] = share * exact.values(name)[late.sum() - 1]
        said = str(compare(exact, sensed(changed(exact, **seen))).likely)
        assert said.startswith("the contact begins late, at foot_x = ")
        assert said.endswith(" L instead of 1.007 L, and agrees from there on")


@pytest.mark.parametrize("drift", [0.0, 0.05, 0.3, 1.0])
def test_a_zero_is_named_with_a_drift_that_shows_beside_it(drift):
    """Of 0.05 a hundredth is left, rms, which is not looked into."""
    force = solved().values("force_y")
    touching = np.flatnonzero(solved().table["phase"] != "free")
    error = np.zeros(len(force))
    error[touching] = 1 + drift * np.linspace(0, 1, len(touching))
    said = str(named(force + 0.02 * force.max() * error))
    assert "zero of force_y" in said
    assert ("drift of force_y" in said) == (drift > 0.1)


def test_of_two_that_fit_alike_both_are_named_and_of_three_none():
    weigh = Weigh(all=1.0, noise=0.0)
    left = {"a": 1e-3, "b": 1.5e-3, "c": 0.1}
    alike = [Explanation(name, x) for name, x in left.items()]
    assert [one and one.text for one in best_alone(alike, weigh)] == ["a", "b"]
    assert best_alone([*alike, Explanation("d", 1.2e-3)], weigh) == (None, None)
    assert best_alone([Explanation("a", 0.2), Explanation("c", 0.5)], weigh) == (None, None)


@pytest.mark.parametrize("rows", [2, pytest.param(5, marks=pytest.mark.slow)])
def test_readings_that_are_held_are_no_foot_that_jitters(rows):
    """Every second reading anew was "jitter of foot_x by 1.5e-02 L"."""
    exact = solve_sweep(replace(named_case("catenary"), sweep=Sweep(100)))
    held = {n: np.repeat(exact.values(n)[::rows], rows)[: len(exact.table)] for n in CLAMP_READINGS}
    seen = sensed(changed(exact, **held))
    assert compare(exact, seen).likely.startswith(f"readings are held: {1 - 1 / rows:.0%} of those")
    too_stiff = scaled(seen, **dict.fromkeys(CLAMP_READINGS, 1.05))
    assert "held" not in (compare(exact, too_stiff).likely or "")
    at = np.arange(len(exact.table))
    few = {n: exact.values(n)[np.where(at % 40 < 6, at - at % 40, at)] for n in CLAMP_READINGS}
    assert "held" not in (compare(exact, sensed(changed(exact, **few))).likely or "")


@pytest.mark.slow
def test_noise_that_hardly_jumps_is_there_without_a_contact_too():
    """It was "the readings alone do not show why"; what is wrong in contact alone is no noise."""
    exact = solve_sweep(replace(named_case("parabola"), sweep=Sweep(200)))
    free = (exact.table["phase"] == "free").to_numpy()
    seen = noisy(exact, relative_noise(exact, 0.02), 2, memory=0.9)
    still = {n: np.where(free, exact.values(n), seen.values(n)) for n in CLAMP_READINGS}
    for sweep, remembers in ((seen, True), (changed(exact, **still), False)):
        bare = replace(exact, table=sensed(sweep).table)
        assert ("noise that remembers" in str(compare(exact, bare).likely)) == remembers


@pytest.mark.parametrize(("jumps", "noise"), [(0.75, True), (0.3, False)])
def test_half_of_the_square_has_to_jump_to_be_noise(jumps, noise):
    """Beside a slow wave that is no other cause."""
    force = solved().values("force_y")
    touching = (force != 0).astype(float)
    white = np.random.default_rng(6).standard_normal(len(force))
    wave = np.sqrt(2) * np.sin(np.arange(len(force)) / 6)
    error = np.sqrt(jumps) * white + np.sqrt(1 - jumps) * wave
    assert str(named(force + 0.02 * force.max() * error * touching)).startswith("noise") == noise


def test_noise_that_is_allowed_for_is_no_cause():
    """It was named, with the advice to estimate it, whatever else was wrong."""
    exact = replace(exact_sweep("parabola"), provenance={})
    off = 0.01 * np.random.default_rng(3).standard_normal((3, len(exact.table)))
    off[2] += 0.01 * np.linspace(-1, 1, len(exact.table))
    seen = {
        n: exact.values(n) + np.abs(exact.values(n)).max() * one
        for n, one in zip(CLAMP_READINGS, off, strict=True)
    }
    found = measure(exact, changed(exact, **seen), 5e-3)
    for level, named in ((0.0, True), (0.01, False)):
        noise = NoiseAllowance(dict.fromkeys(CLAMP_READINGS, level))
        said = str(likely_cause(found, Tolerances(), noise))
        assert said.startswith("noise") == named


@pytest.mark.parametrize(
    ("made", "said"),
    [(unread, "reads no load, though"), (untrusted, "is to be trusted"), (mute, "never touches")],
)
def test_who_touches_is_not_said_never_to_touch(made, said):
    found = compare(solved(), made(solved()))
    assert not found.agrees
    assert said in found.likely
    assert ("never touches" in found.likely) == (made is mute)


@pytest.mark.slow
def test_two_objects_are_no_clamp_that_gives_way():
    """A parabola against a circle was "clamp stiffness about 5.59 EI/L"."""
    one, other = (
        solve_sweep(Case(profile=profile, sweep=Sweep(40)))
        for profile in (parabola(1.0, 0.2), circle(1.0, (0, 0.4)))
    )
    assert compare(one, other).likely.startswith("two objects: parabola")
    assert "two objects" not in (compare(one, one).likely or "")


def test_a_moment_about_another_point_is_named():
    exact = solved()
    moment = exact.values("moment_z") + exact.values("foot_x") * exact.values("force_y")
    found = compare(exact, changed(exact, moment_z=moment))
    assert found.likely == "moment_z is about the world's origin, not the foot"


def test_stations_that_are_not_trusted_are_the_cause_where_the_readings_agree():
    """It was "noise: differences jump from station to station by 1.3e-10"."""
    exact = solved()
    jumps = 1 + 1e-10 * np.random.default_rng(1).standard_normal(len(exact.table))
    status = np.where(np.arange(len(jumps)) % 5 == 0, "unsettled", "ok")
    mine = changed(exact, force_x=jumps * exact.values("force_x"), status=status)
    assert "stations are not to be trusted" in compare(exact, mine).likely


def test_a_load_that_noise_hides_is_no_sensor_without_one():
    """A soft drive swings under the sensor: force_x alone jumped, and "the clamp reads no load"."""
    exact = solved()
    force = exact.values("force_x")
    jumps = 2 * np.abs(force).max() * np.random.default_rng(1).standard_normal(len(force))
    found = compare(exact, changed(exact, force_x=force + jumps, phase=exact.table["phase"]))
    assert found.likely.startswith("force_x jumps from station to station by ")
    loaded = (exact.table["phase"] != "free").sum()
    assert f"reads no load above its noise at any of the {loaded} stations" in str(found)


@pytest.mark.slow
def test_a_contact_ends_early_only_where_it_agrees_up_to_there():
    exact = solve_sweep(named_case("parabola"))
    last = np.flatnonzero(exact.table["phase"] != "free")[-1]
    on = np.arange(len(exact.table)) < last - 2
    early = sensed(changed(exact, **{n: on * exact.values(n) for n in CLAMP_READINGS}))
    assert compare(exact, early).likely.startswith("the contact ends early")
    smaller = solve_sweep(replace(named_case("parabola"), profile=parabola(1.5, 0.5)))
    found = compare(exact, sensed(replace(smaller, table=smaller.table.fillna(0.0))))
    assert found.disagreement["force_x"].rms > 0.05
    assert "ends early" not in (found.likely or "")


def thinner(sweep: Readings) -> Readings:
    """A vibrissa of no thickness, which claims to be the other."""
    case = Case(BEAM, named_case("parabola").profile.scaled(BEAM.length), STATIONS)
    return replace(solve_sweep(replace(case, beam=replace(BEAM, radius=0.0))), beam=BEAM)


def lever(sweep: Readings, arm: float, force: str) -> Readings:
    return changed(sweep, moment_z=sweep.table["moment_z"] + arm * sweep.table[force])


def past(profile, start: float = 1.3, **changed) -> Readings:
    """The sweep of the circle below past another object, over nearly its stations."""
    case = Case(profile=profile, sweep=Sweep(100, start=start, stop=-1.445), **changed)
    return solve_sweep(case)


@pytest.mark.parametrize(
    ("profile", "said"),
    [
        (circle(1.05, (0, 0.4)), r"^size of the object \+5.0.% off"),
        (circle(0.9, (0, 0.4)), r"^size of the object -(9.[5-9]|10.[0-5]).% off"),
        (circle(1.05, (0, 0.35)), r"radius .* \+5.00e-02 .*object larger .* all round by as much$"),
    ],
)
def test_another_size_is_not_taken_for_an_object_that_is_nearer(profile, said):
    found = compare(past(circle(1.0, (0, 0.4)), 0.932), past(profile)).likely
    assert re.search(said, str(found))


@pytest.mark.slow
def test_a_weight_that_was_forgotten_is_named():
    heavy = past(circle(1.0, (0, 0.4)), 0.932, weight=(0.0, -0.5))
    light = past(circle(1.0, (0, 0.4)), 0.932)
    assert compare(heavy, light).likely.startswith("weight of the vibrissa -100% off")


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda sweep: without_offset(sweep, -0.01), r"foot_x \+5.*e-03 L off"),
        (thinner, r"radius of the vibrissa -.*e-03 L off \(it is 5.00e-03 L\)"),
        (lambda sweep: lever(sweep, 0.1, "force_x"), r"sensor \+0.05 L along the vibrissa"),
        (lambda sweep: lever(sweep, -0.1, "force_y"), r"sensor \+0.05 L across the vibrissa"),
    ],
)
def test_a_cause_has_its_sign_and_its_size_in_lengths_of_the_vibrissa(made, said):
    """It is of length 2 here."""
    assert re.search(said, str(compare(solved(), made(solved())).likely))


@pytest.mark.parametrize("off", [pytest.param(0.01, marks=pytest.mark.slow), -0.01])
def test_an_offset_is_found_past_a_reference_of_few_stations(off):
    """Next to its snap-off 100 stations are far apart: it was 1.19e-2, with a fifth left."""
    case = Case(Beam(), circle(0.8, lowest=(0.0, 0.4)), Sweep(100))
    first, last = case.foot_x[[0, -1]]
    moved = circle(0.8, lowest=(off, 0.4))
    seen = solve_sweep(replace(case, profile=moved, sweep=Sweep(100, first, last)))
    said = compare(solve_sweep(case), sensed(seen)).likely
    size = re.fullmatch(r"foot_x (\S+) L off, the same at all stations.*", said)[1]
    assert float(size) == pytest.approx(off, rel=0.01)
    assert "is left" not in said


def test_beside_a_defect_of_the_record_what_is_left_without_a_cause_is_said():
    """Rows that lack a number, and an error that is no fault's signature."""
    exact = replace(solved(), provenance={})
    force = exact.values("force_y") * (1 + 0.05 * np.sin(9 * np.linspace(0, 1, 128) ** 3))
    force[[20, 40]] = np.nan
    found = measure(exact, changed(exact, force_y=force), 5e-3)
    said = likely_cause(found, Tolerances(), NoiseAllowance())
    assert said == "2 of 128 rows lack a number; " + _UNKNOWN


def test_a_cause_of_nearly_all_comes_before_lost_rows():
    """They were called the cause of an opposite sign."""
    exact = solved()
    table = exact.table.assign(force_y=-exact.table["force_y"]).drop(index=range(60, 90))
    found = measure(exact, replace(exact, table=table.reset_index(drop=True)), 5e-3)
    said = likely_cause(found, Tolerances(), NoiseAllowance())
    assert said.startswith("opposite sign of force_y; beside that some 30 rows are not there")


@pytest.mark.slow
def test_a_fitted_offset_may_hide_what_else_is_off():
    """An object 0.01 L lower and 1 % of noise were a curvature of -0.024/L."""
    case = Case(profile=parabola(1.38, 0.69), sweep=Sweep(112, direction="right"))
    lower = solve_sweep(replace(case, profile=parabola(1.38, 0.68)))
    seen = with_noise(lower, dict.fromkeys(CLAMP_READINGS, 0.01), 3)
    said = compare(solve_sweep(case), seen, offset="auto", noise="auto").likely
    assert said is None or "height of the object" in said


@pytest.mark.parametrize("factor", [1e-4, 1 / 40, 1 / 20, 0.21, 3.1, 3.3, 40, 1e4])
def test_one_factor_is_named_as_such_however_large(factor):
    """A spring of EI/L, not EI/l, was a soft clamp and a cone; a moment of 1/40 a gain of 0.2."""
    exact, many = exact_sweep("catenary"), f"{factor:.5g} times"
    many = f"{many if factor > 1 else f'1/{1 / factor:.5g} of'} the reference's: "
    near = 0.2 < factor < 3.2
    for names, said in (
        (
            CLAMP_READINGS,
            "flexural rigidity" if near else f"all readings are {many}EI, or its unit",
        ),
        *(([n], f"gain of {n}" if near else f"{n} is {many}a gain") for n in CLAMP_READINGS),
    ):
        mine = sensed(changed(exact, **{n: factor * exact.values(n) for n in names}))
        cause = compare(exact, mine).likely
        assert cause.startswith(said)
        assert ("in a chain of 40 links" in cause) == (factor == 1 / 40 and len(names) == 3)


def test_stations_far_from_rest_have_no_cause_of_physics():
    """Between once and three times what is due: "flexural rigidity +97 %"."""
    exact = exact_sweep("catenary")
    for seed in range(3):
        size = 1 + 2 * np.random.default_rng(seed).uniform(size=len(exact.table))
        jumping = {n: size * exact.values(n) for n in CLAMP_READINGS}
        assert compare(exact, sensed(changed(exact, **jumping))).likely is None
    wild = np.random.default_rng(1).uniform(-1, 1, len(exact.table)) * (exact.values("force_y") > 0)
    nowhere = compare(exact, sensed(changed(exact, force_x=3 * wild, force_y=3 * wild)))
    assert nowhere.likely.endswith("or its stations are not at rest")
