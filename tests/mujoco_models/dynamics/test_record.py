"""Means over the way round each station, from made-up steps."""

from itertools import pairwise

import numpy as np
import pytest

from mujoco_models.dynamics.record import StationMeans, Step


def driven(record, x, clamp, touches=None):
    """The record of steps at the given foot positions."""
    touches = np.ones(len(x), dtype=bool) if touches is None else touches
    samples = [
        Step(float(i), *values)
        for i, values in enumerate(zip(x.tolist(), clamp, touches.tolist(), strict=True))
    ]
    for before, after in pairwise(samples):
        while True:
            if record.crosses(before, after):
                record.note(before, after, {"phase": "free", "status": "ok"})
            if not record.take(before, after):
                break
    return record


@pytest.mark.parametrize("steps", [7, 50, 1001])  # 7: several stations to a step
@pytest.mark.parametrize("average", [0.0, 0.3, 1.0])
def test_a_straight_line_is_met_exactly(steps, average):
    stations = np.linspace(1, -1, 12)
    record = StationMeans(stations, average)
    x = np.linspace(record.first + 0.01, -1.2, steps)
    clamp = np.column_stack([3 * x + 1, -x, 0 * x + 2])
    driven(record, x, clamp)
    assert record.complete
    for name, expected in (("force_x", 3 * stations + 1), ("force_y", -stations)):
        for column in (name, f"{name}_raw"):
            np.testing.assert_allclose([row[column] for row in record.rows], expected, atol=1e-13)
    assert [row["moment_z"] for row in record.rows] == pytest.approx([2] * 12)


def test_the_mean_removes_a_ripple_that_the_raw_signal_has():
    stations = np.linspace(1, -1, 21)
    record = StationMeans(stations, 1.0)
    x = np.linspace(record.first + 0.01, -1.2, 40_001)
    ripple = np.cos(2 * np.pi * x / 0.1 * 5)  # five periods from a station to the next
    driven(record, x, np.column_stack([ripple] * 3))
    assert max(abs(row["force_x"]) for row in record.rows) < 1e-5
    assert max(abs(row["force_x_raw"]) for row in record.rows) > 0.9


def test_lost_contacts_are_counted_at_the_station_where_they_are_lost():
    stations = np.array([0.5, 0.0, -0.5])
    record = StationMeans(stations, 1.0)
    x = np.linspace(record.first + 0.01, -1, 400)
    chatters = (x < 0.2) & (x > -0.2)
    touches = ~chatters | (np.arange(400) % 2 == 0)
    driven(record, x, np.zeros((400, 3)), touches)
    assert [row["status"] for row in record.rows] == ["ok", "chattering", "ok"]
    assert record.rows[1]["contact_losses"] == pytest.approx(chatters.sum() / 2, abs=1)


def test_one_bounce_spoils_the_mean_of_its_station():
    """Contact is lost once: for 8 % of the second station's way, and the third's last two steps."""
    stations = np.array([1.0, 0.5, 0.0, -0.5])
    record = StationMeans(stations, 1.0)
    x = np.linspace(record.first + 0.01, -1, 2001)
    away = ((x < 0.36) & (x > 0.32)) | ((x < -0.2475) & (x > -0.2495))
    driven(record, x, np.zeros((2001, 3)), ~away)
    assert [row["contact_losses"] for row in record.rows] == [0, 1, 1, 0]
    assert [row["status"] for row in record.rows] == ["ok", "chattering", "ok", "ok"]


def test_the_last_contact_that_is_lost_is_the_snap_off():
    record = StationMeans(np.array([0.5, 0.0]), 0.0)
    x = np.linspace(0.6, -0.1, 71)
    touches = (x > 0.3) & ~((x < 0.42) & (x > 0.4))
    driven(record, x, np.zeros((71, 3)), touches)
    assert record.contact.last == pytest.approx(0.3, abs=0.011)


@pytest.mark.parametrize(("lost", "end"), [(0.3, 0.3), (0.0, None)])
def test_a_second_contact_that_is_lost_with_the_first_has_no_end(lost, end):
    """It is the snap-off that ends both."""
    record = StationMeans(np.array([0.5, -0.2]), 0.0)
    samples = [
        Step(10 * (0.6 - x), x, np.zeros(3), 0.0 < x < 0.55, lost < x < 0.45)
        for x in np.linspace(0.6, -0.3, 901).tolist()
    ]
    for before, after in pairwise(samples):
        record.take(before, after)
    found = record.second_contact()
    assert found["second_contact_start"] == pytest.approx(0.45, abs=2e-3)
    assert found["second_contact_end"] == (end if end is None else pytest.approx(end, abs=2e-3))
