"""A unit that is wrong is called so, with an offset or without; a short sweep is not."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, SENSED, InputError, Readings, named_case, solve_sweep
from compare import compare
from compare.align.offset import without_offset
from compare.align.units import in_units_of
from compare.sense.noise import with_noise
from tests.conftest import exact_sweep

OFFSET = 0.02


def measured(name: str, factors: dict[str, float], level: float = 3e-3) -> Readings:
    """A rig's sweep with other stations, an offset, noise, and units by these factors."""
    case = named_case(name)
    sweep = solve_sweep(replace(case, sweep=replace(case.sweep, stations=157)))
    noisy = with_noise(sweep, dict.fromkeys(CLAMP_READINGS, level), 0)
    moved = without_offset(noisy, -OFFSET).table[list(SENSED)]
    return Readings(moved.assign(**{n: moved[n] * f for n, f in factors.items()}))


NAMES = ("catenary", "parabola", "two-circles")
OTHERS = ({}, {"moment_z": 1e3}, {"force_x": 1e-3, "force_y": 1e-3})
# Each factor with another case, and with something else in another unit; two in the fast tests.
LENGTHS = [
    pytest.param(
        NAMES[i % 3], factor, OTHERS[(i + i // 3) % 3],
        marks=() if factor in (1000.0, 0.1) else pytest.mark.slow,
    )
    for i, factor in enumerate((1000.0, 0.001, 10.0, 0.1, 100.0, 25.4))
]  # fmt: skip


@pytest.mark.parametrize(("name", "factor", "others"), LENGTHS)
def test_another_unit_of_length(name, factor, others):
    rig = measured(name, {"foot_x": factor, **others})
    for offset in ("auto", OFFSET):
        with pytest.raises(
            InputError, match=rf"differ by {max(factor, 1 / factor):g}; "
        ) as refused:
            compare(exact_sweep(name), rig, offset=offset)
        assert "spans" in str(refused.value)


UNITS = [
    ({"moment_z": 1e3}, "moment_z in another unit"),
    ({"moment_z": 1e-3}, "N m taken for N mm"),
    ({"moment_z": 10}, "N mm taken for N cm"),
    ({"force_x": 1e3, "force_y": 1e3}, "force_x and force_y in another unit"),
    ({"force_x": 1e-3, "force_y": 1e-3, "moment_z": 1e-6}, "N m taken for mN mm"),
    ({"force_x": 1e-3, "force_y": 1e-3, "moment_z": 1e-3}, "all readings in another unit"),
    (dict.fromkeys(CLAMP_READINGS, 9.80665), "all readings in another unit: 9.807"),
]


@pytest.mark.parametrize(
    ("name", "factors", "said"), [(NAMES[i % 3], *one) for i, one in enumerate(UNITS)]
)
def test_another_unit_of_a_reading_beside_an_unknown_offset(name, factors, said):
    found = compare(exact_sweep(name), measured(name, factors, 0.0), offset="auto")
    assert found.offset.value == pytest.approx(OFFSET, abs=2e-3)
    assert said in found.likely


SHARES, BEGINS = (0.03, 0.1, 0.3), (0.05, 0.4, 0.6)
# Each share of each case, and each begin of each case and of each share.
PARTS = [(NAMES[i], SHARES[j], BEGINS[(i + j) % 3]) for i in range(3) for j in range(3)]


@pytest.mark.parametrize(("name", "share", "begin"), PARTS)
def test_a_part_of_a_sweep_is_in_the_same_unit(name, share, begin):
    case, whole = named_case(name), exact_sweep(name)
    x = whole.values("foot_x")[np.isin(whole.table["phase"], ("tip", "tangent"))]
    start, length = x[0] + begin * (x[-1] - x[0]), share * (x[-1] - x[0])
    foot = np.linspace(start, start + length, 60)
    columns = {n: np.interp(-foot, -whole.values("foot_x"), whole.values(n)) for n in SENSED}
    part = Readings.of({**columns, "foot_x": foot}, case.beam)
    assert compare(whole, part).alignment.counts["compared"] > 0


def test_readings_in_the_same_units_are_left_alone():
    sweep = exact_sweep("catenary")
    assert in_units_of(sweep, measured("catenary", {})) is not sweep
    twice = measured("catenary", dict.fromkeys(CLAMP_READINGS, 3.0))
    assert in_units_of(sweep, twice) is twice
    dead = measured("catenary", {"moment_z": 0.0})
    assert in_units_of(sweep, dead) is dead
