"""What engines differ by is split into implementation and model, and falls with the segments."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Readings
from compare.explain.fit import fitted
from compare.explain.parts import Shared, convergence, fitted_orders
from compare.explain.split import Split, split
from tests.compare.synthetic import BEAM, EXACT, TOUCHING, at_rest, pattern, rms, scaled, solved

ROLES = {"mine": "subject", "theirs": "twin", "other": "model"}


def off(gain: float, snap_off: float = 0.0) -> Readings:
    """The exact sweep, all its readings too large, and let go later."""
    larger = scaled(solved(), **dict.fromkeys(CLAMP_READINGS, 1 + gain))
    events = {**solved().provenance["events"], "snap_off": solved().snap_off + snap_off}
    return replace(larger, provenance={**solved().provenance, "events": events})


def found(subject: float, twin: float) -> Split:
    sweeps = {"mine": off(subject, -0.02), "theirs": off(twin, 0.01), "other": off(7e-3)}
    return split(solved(), sweeps, ROLES)


def test_a_disagreement_is_split():
    """In three differences of gains; that from the twin is relative to the twin's magnitudes."""
    one = found(3e-3, 1e-3)
    per_gain = {name: rms / 7e-3 for name, rms in one.others["other"].items()}
    assert 0.3 < per_gain["moment_z"] < 1
    for name, gain in per_gain.items():
        assert one.disagreement[name] == pytest.approx(3e-3 * gain, rel=1e-2)
        assert one.model[name] == pytest.approx(1e-3 * gain, rel=1e-2)
        assert one.implementation[name] == pytest.approx(2e-3 / 1.001 * gain, rel=1e-2)
    assert one.snap_off == pytest.approx(-0.03 / BEAM.length)
    assert set(one.others) == {"other"}


@pytest.mark.parametrize(
    ("subject", "twin", "share", "blame"),
    [
        (3e-3, 1e-3, 2 / 3, "implementation"),
        (3e-3, 2e-3, 1 / 3, "model"),
        (1e-3, 3e-3, 2 / 3, "implementation"),  # of whichever is larger
        (3e-3, 3e-3 + 1e-8, 0.0, "model"),  # below rounding
    ],
)
def test_where_most_of_it_is(subject, twin, share, blame):
    one = found(subject, twin)
    assert one.share == pytest.approx(share, rel=2e-2)
    assert one.blame == blame
    assert ("computes this model right" in one.sentence) == (share == 0.0)


def test_without_a_twin_there_is_no_split():
    assert split(solved(), {"mine": off(3e-3)}, ROLES) is None
    assert split(solved(), {"theirs": off(3e-3)}, ROLES) is None


def test_the_disagreement_by_segments():
    """Relative to the largest magnitudes, over the stations that count alone."""
    runs = at_rest(order=2.0, discretisation=1e-2)
    here = TOUCHING & (np.arange(100) % 2 == 0)
    by_segments = convergence(
        Shared(EXACT, here), [runs[name] for name in ("stiff", "two", "four")]
    )
    assert set(by_segments) == {40, 80, 160}
    for segments, errors in by_segments.items():
        expected = 1e-2 * (40 / segments) ** 2 * rms(pattern("discretisation"), here)
        np.testing.assert_allclose([errors[n] for n in CLAMP_READINGS], expected, rtol=1e-9)
    assert convergence(Shared(EXACT, here), [EXACT]) == {}  # which says nothing of segments


@pytest.mark.parametrize("order", [1.0, 1.7, 2.0])
def test_the_order_is_the_slope_of_the_logarithms(order):
    runs = at_rest(order, discretisation=1e-2)
    errors = convergence(Shared(EXACT, TOUCHING), [runs[n] for n in ("four", "stiff", "two")])
    assert fitted_orders(errors) == pytest.approx(dict.fromkeys(CLAMP_READINGS, order))
    bent = {n: dict.fromkeys(CLAMP_READINGS, e) for n, e in ((1, 1.0), (2, 0.5), (4, 0.125))}
    assert fitted_orders(bent)["force_x"] == pytest.approx(1.5)  # between 1 and 2


def test_the_best_size_of_a_signature():
    """What it does not explain is across it; unknown stations do not count."""
    ones, across = np.ones((3, 8)), np.tile([1.0, -1.0], (3, 4))
    error = 0.3 * ones + 0.1 * across
    error[:, -2:] = 9.0
    ones[:, -2:] = np.nan
    size, left, share = fitted(error, ones)
    assert (size, left, share) == pytest.approx((0.3, 18 * 0.01, 0.9))
    assert fitted(error, 0 * error)[:1] == (0.0,)
