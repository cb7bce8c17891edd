"""Which stations are paired with what: never across a border of phases, never without a reading."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import CubicSpline

from analytic import CLAMP_READINGS, Readings
from compare.align.jumps import jumps
from compare.align.stations import Alignment, align, interpolant
from tests.compare.synthetic import BEAM, classified

TIP, TANGENT = "tip", "tangent"
# By foot position: free, tip down to 0.6, tangent down to 0.0, tip down to -0.4, free.
BORDERS = (0.9, 0.6, 0.0, -0.4)
NAMES = ("free", TIP, TANGENT, TIP, "free")


def curve(name: str, x: np.ndarray, piece: np.ndarray) -> np.ndarray:
    """A function of each piece's own, with jumps in between, which no cubic is."""
    k = CLAMP_READINGS.index(name) + 1
    return np.where(np.isin(piece, (0, 4)), 0.0, piece + np.sin(k * x) + np.exp(x * piece / 2))


def made(x: np.ndarray, **columns) -> Readings:
    piece = np.searchsorted(-np.array(BORDERS), -x)
    phase = np.array(NAMES, dtype=object)[piece]
    values = {name: curve(name, x, piece) for name in CLAMP_READINGS}
    arc = BEAM.length * (0.5 + 0.1 * x)
    table = {"foot_x": x, **values, "phase": phase, "contact_arc_length": arc, "status": "ok"}
    return Readings(pd.DataFrame({**table, **columns}), BEAM, "made up")


X = np.linspace(1.2, -0.8, 41)  # every 0.05
REFERENCE = made(X)
BETWEEN = X[:-1] - 0.02


def paired(candidate: Readings, reference=REFERENCE, dropped=None) -> Alignment:
    none = np.zeros(len(candidate.table), dtype=bool)
    judged = classified(reference), classified(candidate)
    return align(reference, candidate, *judged, none if dropped is None else dropped)


def own_spline(name: str, x: np.ndarray, reference=REFERENCE) -> np.ndarray:
    """Through all stations of the piece that `x` lies in, and no other one."""
    x_ref, values = reference.values("foot_x"), reference.values(name)
    of_ref, of_x = (np.searchsorted(-np.array(BORDERS), -at) for at in (x_ref, x))
    found = np.full(len(x), np.nan)
    for piece in np.unique(of_x):
        here = np.flatnonzero(of_ref == piece)
        here = here[np.argsort(x_ref[here])]
        spline = CubicSpline(x_ref[here], values[here])
        found[of_x == piece] = spline(x[of_x == piece])
    return found


def test_one_and_the_same_stations_are_taken_as_they_are():
    found = paired(made(X))
    touching = (REFERENCE.table["phase"] != "free").to_numpy()
    np.testing.assert_array_equal(found.table["station"], np.flatnonzero(touching))
    for name in CLAMP_READINGS:
        for which in ("reference", "candidate"):
            np.testing.assert_array_equal(
                found.table[f"{name}_{which}"], REFERENCE.values(name)[touching]
            )
    expected = dict.fromkeys(found.counts, 0) | {"compared": touching.sum()}
    assert found.counts == expected | {"free": 41 - touching.sum()}


@pytest.mark.parametrize("way", [1, -1], ids=["alike", "against each other"])
@pytest.mark.parametrize("reference", [REFERENCE, made(X[::-1])], ids=["left", "right"])
def test_each_piece_is_interpolated_by_itself(reference, way):
    """Up to the last station before a border, which counts, and not the first behind it."""
    candidate = made(BETWEEN[::way])
    found = paired(candidate, reference)
    x = found.table["at"].to_numpy()
    for name in CLAMP_READINGS:
        there = found.table[f"{name}_reference"]
        np.testing.assert_allclose(there, own_spline(name, x), rtol=1e-12)
        np.testing.assert_array_equal(
            found.table[f"{name}_candidate"], candidate.values(name)[found.table["station"]]
        )
    # The gaps between the last station of a piece and the first of the next one belong to none.
    before, behind = (np.searchsorted(-np.array(BORDERS), -at) for at in (X[:-1], X[1:]))
    within = (before == behind) & np.isin(before, (1, 2, 3))
    np.testing.assert_array_equal(np.sort(x), np.sort(BETWEEN[within]))
    assert found.counts["between_phases"] == len(BORDERS)
    assert found.counts["outside"] == 0
    nearest = REFERENCE.table["contact_arc_length"].to_numpy()[
        np.abs(X[:, None] - x).argmin(axis=0)
    ]
    np.testing.assert_allclose(found.table["contact_arc_length"], nearest, rtol=1e-12)


def test_the_phase_is_the_references_and_contact_in_one_alone_is_not_compared():
    late = made(X, phase=np.where(X > 0.7, "free", np.where(X < 0.3, TIP, TANGENT)))
    found = paired(late)
    assert set(found.table["phase"]) == {TIP, TANGENT}
    one, other = ((sweep.table["phase"] != "free").to_numpy() for sweep in (REFERENCE, late))
    assert found.counts["one_free"] == (one ^ other).sum()
    assert found.counts["compared"] == (one & other).sum()
    assert found.counts["free"] == (~one & ~other).sum()


def test_each_reason_not_to_compare_has_its_own_count():
    """Unsettled, without a number, filled with zeros, and beyond the reference."""
    x = np.append(X, [-0.9, -1.0])
    status = np.full(len(x), "ok", dtype=object)
    status[[10, 15, 41]] = "unsettled", "diverged", "unsettled"
    force = made(x).values("force_x").copy()
    force[20] = np.nan
    dropped = np.arange(len(x)) == 25
    phase = made(x).table["phase"].to_numpy(dtype=object)
    phase[25] = "free"
    found = paired(made(x, status=status, force_x=force, phase=phase), dropped=dropped)
    assert {10, 15, 20, 25}.isdisjoint(found.table["station"])
    assert (found.counts["untrusted"], found.counts["dropped"]) == (4, 1)
    assert (found.counts["outside"], found.counts["one_free"]) == (1, 0)


def test_an_unsettled_station_of_the_reference_parts_its_phase():
    """It is not compared with, and nothing is interpolated over it."""
    status = np.where(np.arange(41) == 18, "unsettled", "ok")
    reference = made(X, status=status)
    same = paired(made(X), reference)
    assert same.counts["reference_untrusted"] == 1
    assert 18 not in same.table["station"].to_numpy()
    between = paired(made(BETWEEN), reference)
    assert {17, 18}.isdisjoint(between.table["station"])
    assert between.counts["between_phases"] == len(BORDERS)
    assert between.counts["reference_untrusted"] == 2
    neither = paired(
        made(BETWEEN, status=np.where(np.arange(40) < 18, "unsettled", "ok")), reference
    )
    assert neither.counts["untrusted"] == 17  # not where the reference has no readings, either


def test_the_same_station_is_one_to_a_billionth_of_the_length():
    """Beyond, it is one between others: at a border it has no phase."""
    last = np.flatnonzero(X > 0.6)[-1]
    for apart, compared in ((0.9e-9, True), (1.1e-9, False)):
        x = X.copy()
        x[last] -= apart * BEAM.length
        assert (last in paired(made(x)).table["station"].to_numpy()) == compared


JUMPS_AT = -0.2  # in the last tip phase, where a contact goes from corner to corner


def jumping(x: np.ndarray, place: float = JUMPS_AT, **columns) -> Readings:
    """The same with a jump within a phase."""
    readings = made(x, **columns)
    table = readings.table
    for name in CLAMP_READINGS:
        table[name] += np.where((x < place) & (x > BORDERS[-1]), 1.0, 0.0)
    return replace(readings, table=table)


@pytest.mark.parametrize("stations", [40, 300])
def test_nothing_is_interpolated_over_a_jump_within_a_phase(stations):
    x = np.linspace(1.19, -0.79, stations)
    found = paired(jumping(x), jumping(X))
    table = found.table[found.table["phase"] != "free"]
    for name in CLAMP_READINGS:
        np.testing.assert_allclose(
            table[f"{name}_reference"], table[f"{name}_candidate"], rtol=0, atol=2e-3
        )
    at = table["at"].to_numpy()
    assert ((at > JUMPS_AT - 0.3) & (at < JUMPS_AT + 0.1)).sum() >= stations / 10


def test_a_station_that_has_jumped_a_little_early_is_left_out_and_no_other():
    """That of a sweep which jumps two stations early is compared, and is as far off as it is."""
    x = np.sort(np.append(X, JUMPS_AT + 1e-3))[::-1]  # of both sweeps, just before the jump
    reference = jumping(x)
    before = int(np.flatnonzero(x == JUMPS_AT + 1e-3)[0])
    found = paired(jumping(x, JUMPS_AT + 2e-3), reference)
    assert before not in found.table["station"].to_numpy()
    all_but_one = (reference.table["phase"] != "free").sum() - 1
    assert found.counts["compared"] == all_but_one and found.counts["beside_jump"] == 1
    early = paired(jumping(x, JUMPS_AT + 0.12), reference).table
    off = (early["force_x_candidate"] - early["force_x_reference"]).abs()
    assert (off > 0.5).sum() == 2 and before not in early["station"].to_numpy()


@pytest.mark.parametrize(("steps", "left_out"), [(40, True), (400, False)])
def test_between_stations_too_far_apart_at_a_bend_nothing_is_compared(steps, left_out):
    """The spline of a bend swings out by a tenth of what a station adds, a few stations wide."""
    x, between = np.linspace(1.2, -0.8, steps + 1), np.linspace(1.19, -0.79, 334)

    def bent(sweep: Readings) -> Readings:
        force = sweep.table["force_y"] + 2 * np.abs(sweep.values("foot_x") - 0.31)
        return replace(sweep, table=sweep.table.assign(force_y=force))

    reference, candidate = bent(made(x)), bent(made(between))
    found = paired(candidate, reference)
    assert (found.counts["reference_coarse"] > 0) == left_out
    table = found.table
    off = (table["force_y_candidate"] - table["force_y_reference"]).abs()
    assert off.max() < 1e-3 * reference.table["force_y"].abs().max()
    near = np.abs(between - 0.31) < 4.01 * (x[0] - x[1])
    assert found.counts["reference_coarse"] <= near.sum()
    assert found.counts["reference_coarse"] + near[table["station"]].sum() == near.sum()


def test_where_readings_jump_or_bend():
    x = np.linspace(1, 0, 60)
    smooth, none = np.sqrt(x + 0.02)[None], np.zeros(1, dtype=int)  # as before a snap-off
    assert jumps(x, smooth, none).size == 0
    noise = np.random.default_rng(1).normal(0, 0.02, (3, 60))
    assert jumps(x, np.sin(x) + noise, none).size == 0
    steps = np.where(x < x[30], 0.3, 0.0) + np.where(x < x[33], -0.5, 0.0)
    assert jumps(x, np.sin(x) + steps[None], none).tolist() == [30, 33]
    assert jumps(x, np.sin(x) + steps[None], np.array([0, 31])).tolist() == [33]
    bent = np.abs(x - (x[40] + x[41]) / 2)[None] * 3
    assert jumps(x, bent, none).tolist() == [40]
    assert jumps(x[:2], smooth[:, :2], none).size == 0


def test_what_is_interpolated_by():
    """A cubic through four places or more, straight lines through fewer, the mean of repeats."""
    x, at = np.array([3.0, 1.0, 2.0, 0.0, 4.0]), np.array([0.3, 2.7])
    cubic = interpolant(x, x**3)
    np.testing.assert_allclose(cubic(at), at**3, rtol=1e-12)
    np.testing.assert_allclose(cubic(at, 1), 3 * at**2, rtol=1e-12)
    np.testing.assert_allclose(interpolant(x[:3], x[:3] ** 2)(np.array([1.5])), [2.5])
    repeated = np.append(x, 2.0)
    np.testing.assert_allclose(
        interpolant(repeated, repeated + np.array([0, 0, -1, 0, 0, 1]))(at), at
    )
    np.testing.assert_array_equal(interpolant(np.ones(2), np.array([1.0, 3.0]))(at), [2.0, 2.0])


def on_facets(angles: np.ndarray) -> Readings:
    """Past a polygon with sides at -0.1, 0 and 0.1 rad."""
    corners = np.array([[-2.0, -1.0, 1.0, 2.0], [np.tan(0.1), 0.0, 0.0, np.tan(0.1)]])
    return replace(made(X, contact_angle=angles), provenance={"contour": corners.tolist()})


@pytest.mark.parametrize(
    ("leapt", "angle", "kept"),
    [([20], 0.1, False), ([20, 21], 0.1, True), ([], 0.1, True), ([20], 0.05, True)],
)
def test_a_station_on_another_facet_alone_is_left_out(leapt, angle, kept):
    """One sweep holds on longer; of two side by side, of none, or within a side, it is a fault."""
    candidate = on_facets(np.where(np.isin(np.arange(41), leapt), angle, 0.0))
    table = candidate.table
    table.loc[20, list(CLAMP_READINGS)] += 0.5
    found = paired(replace(candidate, table=table), on_facets(np.zeros(41)))
    assert (20 in found.table["station"].to_numpy()) == kept
    assert found.counts["beside_jump"] == (not kept)
