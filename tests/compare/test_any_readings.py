"""Whatever two readings hold, comparing them ends in a comparison or in one clear line."""

import json
import warnings
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from analytic import CLAMP_READINGS, Beam, InputError, Readings
from compare import compare
from tests.conftest import exact_sweep

_ODD = [0.0, -0.0, 1.0, -1.0, 1e-320, -1e-320, 1e-200, 1e30, 1e200, np.nan]
_NUMBERS = st.one_of(st.sampled_from(_ODD), st.floats(-10, 10), st.integers(-3, 3).map(float))
_PLACES = st.one_of(st.integers(-3, 3).map(float), st.floats(-5, 5))


@st.composite
def any_readings(draw) -> Readings:
    stations = draw(st.integers(2, 14))
    columns = {"foot_x": draw(st.lists(_PLACES, min_size=stations, max_size=stations))}
    for name in CLAMP_READINGS:
        columns[name] = draw(st.lists(_NUMBERS, min_size=stations, max_size=stations))
    return Readings(pd.DataFrame(columns))


@st.composite
def spoilt_sweep(draw) -> Readings:
    """A sound sweep with some rows taken, repeated, shifted or overwritten."""
    table = exact_sweep("parabola").table[["foot_x", *CLAMP_READINGS]]
    rows = draw(st.lists(st.integers(0, len(table) - 1), min_size=2, max_size=60))
    rows = sorted(rows) if draw(st.booleans()) else rows
    table = table.iloc[rows].reset_index(drop=True)
    if draw(st.booleans()):
        table["foot_x"] = np.round(table["foot_x"], draw(st.integers(0, 2)))
    if draw(st.booleans()):
        name = draw(st.sampled_from(CLAMP_READINGS))
        table.loc[draw(st.integers(0, len(table) - 1)) :, name] = draw(st.sampled_from(_ODD))
    return Readings(table)


def outcome(reference: Readings, candidate: Readings, **how) -> None:
    """Compare, and use everything that a comparison offers."""
    try:
        found = compare(reference, candidate, **how)
    except InputError as error:
        assert "\n" not in str(error)
        return
    json.dumps(found.to_dict(), allow_nan=False)
    assert len(repr(found)) < 4000
    assert "0.0e+00" not in " ".join([*found.failures, found.likely or ""])
    for d in found.disagreement.values():
        assert not d.max < d.rms * (1 - 1e-12)
    if not found.alignment.counts["compared"]:
        assert not found.agrees


@settings(max_examples=15, deadline=None, suppress_health_check=list(HealthCheck))
@given(any_readings(), any_readings())
def test_any_two_readings(reference, candidate):
    outcome(reference, candidate)
    outcome(exact_sweep("parabola"), candidate)


@settings(max_examples=8, deadline=None, suppress_health_check=list(HealthCheck))
@given(spoilt_sweep(), st.sampled_from([{}, {"offset": "auto"}, {"noise": "auto"}]))
def test_any_spoilt_sweep(candidate, how):
    outcome(exact_sweep("parabola"), candidate, **how)


def test_integers_and_repeats_as_foot_positions():
    x = np.repeat(np.arange(2, -3, -1), 3)
    table = pd.DataFrame({"foot_x": x, "force_x": 0.0, "force_y": 1.0, "moment_z": 0.5 - x / 10})
    found = compare(Readings(table), Readings(table.assign(foot_x=x.astype(float))))
    assert found.disagreement["moment_z"].stations == 15


def test_a_reference_that_never_touches_is_no_reference():
    exact = exact_sweep("catenary")
    idle = dict.fromkeys(CLAMP_READINGS, 0.0)
    with pytest.raises(InputError, match=r"contact of the reference .* = none"):
        compare(replace(exact, table=exact.table.assign(**idle)), exact)


def test_a_load_of_rounding_is_none():
    """What is below the rounding of the other readings scales nothing."""
    exact = exact_sweep("catenary")
    tiny = replace(exact, table=exact.table.assign(moment_z=1e-320, force_x=-1e-200))
    found = compare(tiny, exact)
    assert all(np.isfinite(d.rms) for d in found.disagreement.values())
    with pytest.raises(InputError, match="contact of the reference"):
        compare(replace(tiny, table=tiny.table.assign(force_y=1e-320)), exact)


@pytest.mark.parametrize(
    ("given_", "said"),
    [
        ({"candidate": pd.DataFrame()}, "candidate = a DataFrame: must be a Readings"),
        ({"reference": None}, "reference = a NoneType"),
        ({"tolerances": 2e-3}, "tolerances = a float"),
        ({"offset": np.nan}, "offset = nan"),
        ({"offset": "5 mm"}, "offset = '5 mm'"),
        *(({"noise": level}, "noise = ") for level in ("none", -0.1, 1.0, np.nan)),
    ],
)
def test_what_is_no_reading_is_an_error(given_, said):
    exact = exact_sweep("catenary")
    with pytest.raises(InputError, match=said):
        compare(**{"reference": exact, "candidate": exact, **given_})


@pytest.mark.slow
def test_a_million_rows():
    """A rig's file at 10 kHz is compared, but for the borders of phases and the snap-off's.

    Between the last three stations of 200 before that, the reference is not known well enough.
    """
    rng = np.random.default_rng(0)
    exact = exact_sweep("parabola")
    x = np.linspace(*exact.values("foot_x")[[0, -1]], 1_000_000)
    columns = {
        name: np.interp(-x, -exact.values("foot_x"), exact.values(name))
        + 2e-3 * np.abs(exact.values(name)).max() * rng.standard_normal(len(x))
        for name in CLAMP_READINGS
    }
    rig = Readings(pd.DataFrame({"foot_x": np.round(x, 5), **columns}), Beam(), "rig")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = compare(exact, rig, noise="auto")
    assert found.alignment.counts["compared"] > 890_000
    assert found.alignment.counts["reference_coarse"] < 16_000
