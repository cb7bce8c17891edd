"""Defects of a record are counted, and what is no defect is not."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, InputError, Readings
from compare.sense.noise import with_noise
from compare.sense.record import check_size, inspect_record, without_dropouts
from tests.compare.synthetic import changed
from tests.conftest import exact_sweep


@pytest.fixture
def noisy() -> Readings:
    return with_noise(exact_sweep("parabola"), dict.fromkeys(CLAMP_READINGS, 2e-3), 3)


def column(sweep: Readings, name: str, rows, value: float) -> Readings:
    values = sweep.values(name).copy()
    values[rows] = value
    return changed(sweep, **{name: values})


def test_a_sound_record(exact, simulated):
    for sweep in (exact, simulated):
        assert list(inspect_record(sweep).defects()) == []
        assert inspect_record(sweep).sound.all()


def test_defects_are_counted(noisy):
    rows = slice(60, 72)
    assert inspect_record(column(noisy, "moment_z", rows, np.nan)).missing.sum() == 12
    assert inspect_record(column(noisy, "force_y", rows, 0.0)).dropped.sum() == 12
    doubled = noisy.table.iloc[np.sort([*range(200), 40, 90, 91])].reset_index(drop=True)
    assert inspect_record(replace(noisy, table=doubled)).repeated.sum() == 3
    limit = 0.8 * noisy.values("moment_z").max()
    over = noisy.values("moment_z") >= limit
    found = inspect_record(changed(noisy, moment_z=noisy.values("moment_z").clip(max=limit)))
    np.testing.assert_array_equal(found.clipped, over)
    assert found.where_clipped == ("moment_z",)
    holed = inspect_record(replace(noisy, table=noisy.table.drop(range(80, 90))))
    assert holed.gaps == 1 and holed.holes == {79: 10}
    assert "some 10 rows are not there: foot_x leaps" in list(holed.defects())
    fine = noisy.table.iloc[np.sort([*range(0, 120, 8), *range(120, 200)])]
    assert inspect_record(replace(noisy, table=fine)).holes == {}  # fewer at first, as it likes
    # A station that says that it failed lacks nothing.
    status = ["unsettled" if 60 <= i < 72 else "ok" for i in range(200)]
    failed = changed(column(noisy, "force_x", slice(60, 72), np.nan), status=status)
    assert inspect_record(failed).missing.sum() == 0


def test_what_is_no_defect(noisy):
    """A coarse converter, a stage that jitters, a force that passes through zero, an idle clamp."""
    step = noisy.values("force_y").max() / 500
    coarse = changed(noisy, force_y=np.round(noisy.values("force_y") / step) * step)
    jitter = np.random.default_rng(1).normal(0, 0.01, 200)
    jittered = changed(noisy, foot_x=noisy.values("foot_x") + jitter)
    crossing = np.argmin(np.abs(noisy.values("force_x")[20:150])) + 20
    through_zero = column(noisy, "force_x", [crossing], 0.0)
    idle = changed(
        exact_sweep("parabola"), moment_z=exact_sweep("parabola").values("moment_z") - 0.3
    )
    for sweep in (coarse, jittered, through_zero, idle):
        assert list(inspect_record(sweep).defects()) == []


@pytest.mark.parametrize("steps", [15, 33, 60])
def test_a_converter_of_few_steps_is_no_defect(steps):
    """Its zeros next to a touch were rows filled with zeros, its extremes were cut off."""
    exact = exact_sweep("parabola")
    draw = np.random.default_rng(steps).standard_normal
    coarse = {}
    for name in CLAMP_READINGS:
        in_steps = steps * exact.values(name) / np.abs(exact.values(name)).max()
        coarse[name] = np.round(in_steps + 0.1 * draw(len(in_steps))) / steps
    assert list(inspect_record(changed(exact, **coarse)).defects()) == []


def test_dropouts_become_gaps(noisy):
    """Ten rows filled with zeros amid contact; zeros without a contact stay."""
    table = noisy.table.copy()
    columns = list(CLAMP_READINGS)
    table.loc[range(60, 110, 5), columns] = 0.0
    table.loc[:2, columns] = 0.0
    found = without_dropouts(replace(noisy, table=table))
    assert np.flatnonzero(np.isnan(found.values("force_y"))).tolist() == list(range(60, 110, 5))
    assert found.provenance["rows"]["dropped"] == 10
    assert without_dropouts(noisy) is noisy


def test_a_foot_that_never_moves_is_refused(noisy):
    """It was compared, as rows that repeat others."""
    with pytest.raises(InputError, match=r"foot_x of the candidate .* = 0.5 at all stations"):
        check_size("candidate", changed(noisy, foot_x=0.5))
