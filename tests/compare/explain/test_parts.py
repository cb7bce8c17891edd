"""The arithmetic of a budget: one known part each, which it finds to the last digit but six."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, InputError
from compare.explain.budget import Budget, budget, common_stations
from compare.explain.variations import STEP
from tests.compare.synthetic import (
    EXACT,
    SCALE,
    SIZES,
    TANGENT,
    TOUCHING,
    TRUTH,
    UNITS,
    VARIED,
    added,
    at_rest,
    changed,
    pattern,
    rms,
    sweep,
)

SIZE = 1e-2


def split(order=2.0, **sizes) -> Budget:
    return budget(EXACT, at_rest(order, **sizes), VARIED)


def of(found: Budget, name: str, what: str = "rms") -> np.ndarray:
    return np.array([getattr(found.parts[name][reading], what) for reading in CLAMP_READINGS])


# What a budget calls each part, and its rms where the size is 1.
PARTS = {
    **dict.fromkeys(
        ("discretisation", "facets", "softness", "corner", "unrest", "unexplained"), SIZES
    ),
    "sensor": UNITS / SCALE,
    "extension": SIZES,
}


@pytest.mark.parametrize("planted", PARTS)
@pytest.mark.parametrize("order", [1.0, 1.6, 2.0])
def test_one_part_is_found_whole_and_no_other(planted, order):
    """The discretisation is always there: the order is observed in it."""
    sizes = {"discretisation": 3e-3} | {planted: SIZE}
    found = split(order, **sizes)
    assert found.order == pytest.approx(order, abs=1e-6)
    for name in found.parts:
        np.testing.assert_allclose(of(found, name), sizes.get(name, 0) * PARTS[name], 0, 1e-9)
    assert found.blame == planted
    assert found.stations == TOUCHING.sum()


def test_all_parts_at_once_are_taken_apart():
    sizes = {name: SIZE * 0.8**i for i, name in enumerate(PARTS)}
    found = split(**sizes)
    assert set(found.parts) == set(PARTS)
    for name, size in sizes.items():
        np.testing.assert_allclose(of(found, name), size * PARTS[name], rtol=1e-6)
    base = np.stack([at_rest(**sizes)["base"].values(name) for name in CLAMP_READINGS])
    total = rms(base / SCALE[:, None] - TRUTH)
    np.testing.assert_allclose(list(found.disagreement.values()), total, rtol=1e-9)


# By the part that is there: its own uncertainty over its size, and that of what is unexplained.
UNCERTAINTIES = {
    "facets": (0.0, 0.0),
    "softness": (0.1, 0.1),
    "corner": (1.25 / 9, 1.25 / 9),
    "unrest": (1.0, np.sqrt(2)),  # and that of the facets, which are distinguished from it
    "sensor": (1.0, 1.0),
    "extension": (1.0, 1.0),
}


@pytest.mark.parametrize("planted", UNCERTAINTIES)
def test_a_part_is_as_uncertain_as_its_extrapolation(planted):
    own, left = (share * SIZE * PARTS[planted] for share in UNCERTAINTIES[planted])
    found = split(**{planted: SIZE})
    np.testing.assert_allclose(of(found, planted, "uncertainty"), own, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(of(found, "unexplained", "uncertainty"), left, rtol=1e-6, atol=1e-7)
    if planted == "unrest":
        np.testing.assert_allclose(of(found, "facets", "uncertainty"), own, rtol=1e-6)


@pytest.mark.parametrize(("order", "left"), [(1.0, 0.0), (1.6, 1.0), (2.0, 0.0)])
def test_the_discretisation_is_as_uncertain_as_its_finest_sweep_if_no_order_is_seen(order, left):
    found = split(order, discretisation=SIZE)
    expected = left * 1.25 * SIZE * SIZES / 4**order
    np.testing.assert_allclose(of(found, "discretisation", "uncertainty"), expected, 1e-6, 1e-12)


def test_the_limit_is_a_line_in_the_power_of_h_weighed_by_it():
    """By hand, of second order: (24 u_4 - 2 u_2 - u_1)/21, where u_2 alone is c less than it is.

    Left in the three is 60/sqrt(378) c, which the limit has sqrt(14)/42 of; the two finest alone
    would lead c/3 away, and the observed order is more than two, and counts as two.
    """
    c = SIZE / 10
    found = split(discretisation=SIZE, two=-c)
    assert found.order == 2.0
    np.testing.assert_allclose(of(found, "discretisation"), (SIZE - c * 2 / 21) * SIZES, rtol=1e-9)
    np.testing.assert_allclose(of(found, "unexplained"), c * 2 / 21 * SIZES, rtol=1e-9)
    extrapolated = 1.25 * (c / 3 - c * 2 / 21)
    doubt = 1.7 * c * 60 / np.sqrt(378) * np.sqrt(14) / 42
    np.testing.assert_allclose(
        of(found, "discretisation", "uncertainty"), np.hypot(extrapolated, doubt) * SIZES, rtol=1e-9
    )


@pytest.mark.parametrize(("order", "counts_as"), [(0.5, 1.0), (3.0, 2.0)])
def test_an_order_that_no_chain_has_is_not_extrapolated_with(order, counts_as):
    assert split(order, discretisation=SIZE).order == counts_as


def test_what_swings_from_joint_to_joint_is_discretisation():
    """Where the joints are known; else that part of it which all three share stays in the limit."""
    found = split(discretisation=1e-3, swing=1.0)
    assert of(found, "unexplained").max() < 1e-9
    without = {
        name: replace(run, provenance={"settings": run.provenance["settings"]})
        for name, run in at_rest(discretisation=1e-3, swing=1.0).items()
    }
    assert of(budget(EXACT, without, VARIED), "unexplained").min() > 1e-6


@pytest.mark.parametrize(
    ("sizes", "closes", "undecided"),
    [
        ({"unexplained": 4e-6}, True, False),  # twice as much in force_y: 1e-5 is not resolved
        ({"unexplained": 6e-6}, False, False),
        ({"softness": 0.1, "missing": 0.09}, True, False),  # a tenth is uncertain
        ({"softness": 0.1, "missing": 0.12}, False, False),
        ({"facets": 0.1, "unexplained": 5e-3}, False, False),  # small, and nothing is uncertain
        ({"facets": 1e-2, "unrest": 2e-3}, True, False),  # a third of the whole may be uncertain
        ({"facets": 1e-2, "unrest": 3e-3}, False, True),
    ],
)
def test_when_a_budget_closes(sizes, closes, undecided):
    """Of softness what is missing has the same pattern, so that the whole is their sum."""
    share = sizes.pop("missing", 0.0)
    more = share * sizes.get("softness", 0.0) * pattern("softness")
    runs = {name: added(run, more) for name, run in at_rest(**sizes).items()}
    found = budget(EXACT, runs, VARIED)
    assert (found.closes, found.undecided) == (closes, undecided)


def test_phases_have_their_own_rms():
    found = split(softness=SIZE, facets=2 * SIZE)
    for name, size in (("softness", SIZE), ("facets", 2 * SIZE), ("unexplained", 0.0)):
        for phase, here in (("tangent", TANGENT), ("tip", TOUCHING & ~TANGENT)):
            seen = [found.by_phase[name][reading][phase] for reading in CLAMP_READINGS]
            np.testing.assert_allclose(seen, size * rms(pattern(name), here), 0, 1e-9)


def test_the_closed_form_says_the_same_of_softness_and_facets():
    """A contact that gives way, and a polygon's own sweep."""
    faceted = sweep(TRUTH + SIZE * pattern("facets"))
    found = budget(EXACT, at_rest(softness=SIZE), VARIED, faceted)
    checks = {name: [by[r] for r in CLAMP_READINGS] for name, by in found.checks.items()}
    np.testing.assert_allclose(checks["softness"], SIZE * SIZES, rtol=1e-9)
    np.testing.assert_allclose(checks["facets"], SIZE * SIZES, rtol=1e-9)


def test_a_fault_of_the_physics_is_suspected_by_its_size():
    wrong = {name: added(run, 2.5e-2 * pattern("friction")) for name, run in at_rest().items()}
    (suspect,) = budget(EXACT, wrong, VARIED).suspects
    assert (suspect.name, suspect.share) == ("friction", pytest.approx(1.0))
    assert suspect.change == pytest.approx(2.5e-2)  # a signature is of a change by `STEP`
    assert pytest.approx(1e-3) == STEP
    assert split(unexplained=2e-5).suspects == ()  # too small


def test_what_is_left_out():
    """Unsettled in one sweep, free in one, without a number in one, not solved with a change."""
    runs = at_rest(discretisation=SIZE)
    status, phase = (
        np.full(100, "ok", dtype=object),
        EXACT.table["phase"].to_numpy(object, copy=True),
    )
    status[40], phase[50] = "unsettled", "free"
    force = runs["stiff"].values("force_x").copy()
    moment = VARIED["radius"].values("moment_z").copy()
    force[60] = moment[70] = np.nan
    runs["two"] = changed(runs["two"], status=status)
    runs["calm"] = changed(runs["calm"], phase=phase)
    runs["stiff"] = changed(runs["stiff"], force_x=force)
    varied = VARIED | {"radius": changed(VARIED["radius"], moment_z=moment)}
    found = budget(EXACT, runs, varied)
    assert found.stations == TOUCHING.sum() - 4
    here = TOUCHING & ~np.isin(np.arange(100), [40, 50, 60, 70])
    expected = SIZE * rms(pattern("discretisation"), here)
    np.testing.assert_allclose(of(found, "discretisation"), expected, rtol=1e-6)
    lost = {name: changed(run, status="unsettled") for name, run in runs.items()}
    with pytest.raises(InputError):
        budget(EXACT, lost, varied)


def test_the_window_before_the_snap_off_is_left_out():
    at = EXACT.values("foot_x")
    ends = sweep(TRUTH, {"events": {"snap_off": float(at[89]) - 1e-3}})
    kept = common_stations(ends, [EXACT], 0.05)  # 0.15 of a sweep over 3
    np.testing.assert_array_equal(kept, TOUCHING & (at > at[89] - 1e-3 + 0.15))
    found = budget(ends, at_rest(), VARIED)
    assert found.stations == common_stations(ends, [EXACT]).sum() == TOUCHING.sum() - 1


def test_sweeps_that_refining_does_not_change_have_no_discretisation():
    found = split(discretisation=0.0, facets=SIZE)
    assert found.order == 2.0
    np.testing.assert_allclose(of(found, "discretisation"), 0, atol=1e-12)
    np.testing.assert_allclose(of(found, "facets"), SIZE * SIZES, rtol=1e-9)
