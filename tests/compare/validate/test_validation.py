"""The verdict of a validation, on errors that are known."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from analytic import CLAMP_READINGS, Beam, Case, InputError, Sweep, circle, named_case, solve_sweep
from compare import Input, Uncertainties, compare, validate
from compare.measure.measurement import measure
from compare.validate.sensitivities import sensitivities
from compare.validate.stated import INPUTS
from tests.analytic.noisy import noisy
from tests.compare.validate.experiments import CASES, off

NO_NOISE = dict.fromkeys(CLAMP_READINGS, 0.0)


def validated(case, errors, stated, **options):
    return validate(measure(solve_sweep(case), off(case, errors), 5e-3), case, stated, **options)


def test_a_rigidity_that_is_off_by_one_standard_uncertainty():
    """All readings scale alike: E is u_val wherever the contact is."""
    case = CASES["parabola"]
    stated = Uncertainties({"flexural_rigidity": Input(0.02)}, NO_NOISE)
    found = validated(case, {"flexural_rigidity": 0.02}, stated, samples=8)
    assert found.whole.error == pytest.approx(found.whole.u_val, rel=1e-9)
    assert found.whole.coverage == pytest.approx(2, abs=1e-3)
    assert found.whole.u_input == pytest.approx(found.whole.u_val)
    np.testing.assert_allclose(found.table.error, -np.sign(-found.table.error) * found.table.u_val)
    assert (found.dominant, found.resolved, found.dominates) == ("flexural_rigidity", False, True)
    # All of it is the rigidity's error, so whoever knows that better sees less of it.
    assert found.shrink is found.shrink_all is None


def test_an_error_of_the_model_is_resolved():
    case = CASES["circle"]
    stated = Uncertainties({"flexural_rigidity": Input(1e-3)}, NO_NOISE)
    found = validated(case, {"friction": 0.05}, stated, samples=8)
    assert found.resolved
    assert found.shrink == 1.0
    assert repr(found).startswith("Validation(resolved: E ")
    assert found.whole.error > 3 * found.whole.limit


@pytest.mark.parametrize(
    ("errors", "name", "standard"),
    [({"friction": 0.02}, "flexural_rigidity", 0.03), ({"height": 3e-3}, "foot_x", 0.01)],
)
def test_an_input_known_so_much_better_resolves_an_error_of_something_else(errors, name, standard):
    """Its own error, here of half its uncertainty, gets less with that."""
    seen, factor = [], 1.0
    for _ in range(2):
        known = Uncertainties({name: Input(factor * standard)}, NO_NOISE)
        one = {**errors, name: factor * standard / 2}
        seen.append(validated(CASES["circle"], one, known, samples=4))
        factor = seen[0].shrink
    assert [found.resolved for found in seen] == [False, True]
    assert seen[1].whole.error < 0.95 * seen[0].whole.error


def test_noise_alone_is_not_said_to_hide_an_error():
    """Less of it makes E less, too: by the E that there is now 0.3 of it was to do."""
    case, rng = CASES["circle"], np.random.default_rng(0)
    exact = off(case, {})
    size = {n: 0.02 * np.abs(exact.values(n)).max() for n in CLAMP_READINGS}
    known = Uncertainties({"flexural_rigidity": Input(2e-3)}, size)
    found = validate(measure(solve_sweep(case), noisy(exact, size, rng), 5e-3), case, known)
    assert (found.dominant, found.shrink, found.shrink_all) == ("noise", None, None)


@pytest.mark.parametrize(
    "name", [name for name in INPUTS if name not in ("clamp_stiffness", "tip_radius")]
)
def test_sensitivities_are_differences_of_sweeps(name):
    """Large changes, whose differences have an error of second order that is cancelled."""
    case = CASES["circle"]
    found = sensitivities(case, Uncertainties({name: Input(1.0)}), samples=0)
    step = 2e-4
    if name == "natural_curvature":
        same = replace(case, sweep=Sweep(200, *case.foot_x[[0, -1]].tolist()))
        swept = {
            way: solve_sweep(replace(same, beam=replace(case.beam, natural_curvature=way * step)))
            for way in (1, -1)
        }
    elif name == "friction":  # one-sided: of second order by three sweeps
        swept = {1: off(case, {name: step}), 2: off(case, {name: 2 * step}), 0: off(case, {})}
    else:
        swept = {way: off(case, {name: way * step}) for way in (1, -1)}
    here = np.linspace(-0.8, 0.6, 20)

    def at(readings, reading):
        x = readings.values("foot_x")
        return np.interp(here, x[::-1], readings.values(reading)[::-1])

    for i, reading in enumerate(CLAMP_READINGS):
        value = {way: at(sweep, reading) for way, sweep in swept.items()}
        if name == "friction":
            expected = (4 * value[1] - value[2] - 3 * value[0]) / (2 * step)
        else:
            expected = (value[1] - value[-1]) / (2 * step)
        slope = found.readings[0, i]
        got = np.interp(here, case.foot_x[::-1], slope[::-1])
        # Where a phase begins or ends the stations of both are on either side of it.
        apart = np.quantile(np.abs(got - expected), 0.85)
        assert apart < 0.01 * np.abs(expected).max()


@pytest.mark.slow
def test_a_soft_clamp_and_its_stiffness():
    """The rotation at the clamp is M/c: a stiffer one by d c turns less by M d c/c^2."""
    case = Case(profile=circle(1.0, (0.0, 0.4)), clamp_stiffness=8.0)
    found = sensitivities(case, Uncertainties({"clamp_stiffness": Input(0.1)}), samples=8)
    assert np.nanmax(np.abs(found.readings)) > 1e-3
    missed = np.nan_to_num(found.samples - found.predicted)
    assert np.sqrt(np.mean(missed**2)) < 0.02 * np.sqrt(np.nanmean(found.samples**2))


@pytest.mark.slow
def test_a_cone_with_a_radius_at_its_tip():
    case = Case(Beam(radius=0.01, tip_radius=0.002), circle(1.0, (0.0, 0.4)), Sweep(30))
    stated = Uncertainties({"tip_radius": Input(1e-4), "flexural_rigidity": Input(0.01)})
    found = sensitivities(case, stated, samples=4)
    exact = solve_sweep(case)
    for i, name in enumerate(CLAMP_READINGS):
        known = np.isfinite(found.readings[1, i])
        np.testing.assert_allclose(
            found.readings[1, i][known], 0.01 * exact.values(name)[known], rtol=1e-4, atol=1e-6
        )
    assert np.nanmax(np.abs(found.readings[0])) > 1e-4


def test_units_do_not_matter():
    plain = CASES["circle"]
    length, rigidity = 0.05, 2e-6
    beam = Beam(length, rigidity, 0.005 * length)
    case = replace(plain, beam=beam, profile=plain.profile.scaled(length))
    sizes = {"length": 1e-3, "flexural_rigidity": 0.01, "foot_x": 1e-3, "gain_moment_z": 0.01}
    units = {"length": length, "flexural_rigidity": rigidity, "foot_x": length}
    one, other = (
        validated(
            which,
            {"length": 1e-3 * unit.get("length", 1.0)},
            Uncertainties({n: Input(x * unit.get(n, 1.0)) for n, x in sizes.items()}, NO_NOISE),
            samples=4,
        )
        for which, unit in ((plain, {}), (case, units))
    )
    assert other.whole.error == pytest.approx(one.whole.error, rel=1e-6)
    assert other.whole.u_val == pytest.approx(one.whole.u_val, rel=1e-6)
    assert other.dominant == one.dominant


def test_noise_is_what_the_data_show_where_none_is_stated():
    case = named_case("parabola")
    exact = solve_sweep(case)
    rng = np.random.default_rng(0)
    noisy = {n: exact.values(n) + 0.01 * rng.standard_normal(200) for n in CLAMP_READINGS}
    data = replace(exact, table=exact.table.assign(**noisy), source="measured")
    found = validate(measure(exact, data, 5e-3), case, Uncertainties(noise={"force_x": 0.02}))
    scale = {n: np.abs(exact.values(n)).max() for n in CLAMP_READINGS}
    assert found.noise["force_x"] == pytest.approx(0.02 / scale["force_x"])
    assert found.noise["moment_z"] == pytest.approx(0.01 / scale["moment_z"], rel=0.25)
    assert "force_x stated" in found.noise_source
    assert found.dominant == "noise"


@pytest.mark.slow
def test_data_whose_noise_remembers_have_a_wider_limit():
    """What a validation of a right model is expanded by: 1.1 for white noise, more for AR(0.97)."""
    case = CASES["circle"]
    exact, rng = solve_sweep(case), np.random.default_rng(4)
    size = {n: 0.01 * np.abs(exact.values(n)).max() for n in CLAMP_READINGS}
    data, known = off(case, {}), Uncertainties({"length": Input(1e-5)}, size)
    factor = {}
    for rho in (0.0, 0.97):
        white = rng.standard_normal((3, len(data.table))) * np.sqrt(1 - rho**2)
        noise = dict(zip(CLAMP_READINGS, lfilter([1], [1, -rho], white, axis=1), strict=True))
        read = {n: data.values(n) + size[n] * noise[n] for n in CLAMP_READINGS}
        found = validate(measure(exact, replace(data, table=data.table.assign(**read)), 5e-3),
                         case, known, samples=4)  # fmt: skip
        factor[rho] = found.whole.coverage
    assert factor[0.0] < 1.12
    assert factor[0.97] > 1.25


@pytest.mark.slow
def test_a_fitted_offset_is_as_uncertain_as_its_fit():
    case = named_case("parabola")
    exact = solve_sweep(case)
    shifted = replace(exact, table=exact.table.assign(foot_x=exact.values("foot_x") + 0.01))
    found = compare(exact, shifted, offset="auto")
    stated = Uncertainties({"foot_x": Input(0.01)})
    known = found.validated(case, stated).validation  # of 64 samples
    assert known.standard["foot_x"] == pytest.approx(found.offset.uncertainty / 1.96)


@pytest.mark.parametrize(
    ("stated", "why"),
    [
        (lambda: Uncertainties({"lenght": Input(1)}), "lenght"),
        (lambda: Input(-1.0), "standard uncertainty"),
        (lambda: Uncertainties(noise={"force_z": 1.0}), "force_z"),
        (
            lambda: Uncertainties({"length": Input.within(1)}, {}, (("length", "radius", 1),)),
            "corr",
        ),
        (
            lambda: Uncertainties(
                dict.fromkeys(("length", "radius", "foot_x"), Input(1)),
                {},
                (("length", "radius", 1), ("radius", "foot_x", 1), ("length", "foot_x", -1)),
            ),
            "correlations",
        ),
    ],
)
def test_what_cannot_be_stated(stated, why):
    with pytest.raises(InputError, match=why):
        stated()


@pytest.mark.parametrize(
    ("inputs", "noise", "samples", "said"),
    [
        ({"gain_force_x": Input(1e100)}, 0.0, 2, "check the units"),
        ({}, 1e100, 2, "check the units"),
        ({"height": Input(2.0)}, 0.0, 16, "cannot be solved"),
    ],
)
def test_uncertainties_in_another_unit(inputs, noise, samples, said):
    stated = Uncertainties(inputs, {**NO_NOISE, "force_x": noise})
    with pytest.raises(InputError, match=said):
        validated(CASES["circle"], {}, stated, samples=samples)
