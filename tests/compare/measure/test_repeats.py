"""The mean of passes: what is the same in all is no difference between them."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, SENSED, Readings
from compare import compare
from compare.measure.repeats import repeats
from compare.show.passes import repeats_summary
from tests.conftest import exact_sweep


def passes(name, noise, rng):
    exact = exact_sweep(name)
    for _ in range(6):
        table = exact.table[list(SENSED)].fillna(0.0)
        for reading in CLAMP_READINGS:
            largest = table[reading].abs().max()
            table[reading] += noise * largest * rng.standard_normal(len(table))
        yield Readings(table, exact.beam)


@pytest.mark.parametrize("name", ["catenary", "parabola"])
@pytest.mark.parametrize("noise", [1e-6, 1e-2])
def test_passes_alike_are_not_displaced_and_their_mean_is_the_sweep(name, noise):
    """Four stations are averaged, over bends and next to the snap-off: neither may show."""
    exact, rng = exact_sweep(name), np.random.default_rng(1)
    found = repeats([*passes(name, noise, rng)])
    shifts = found.shifts.numbers.ravel()
    assert abs(shifts.mean()) < 0.1 * noise
    assert (np.abs(shifts) < 4 * found.uncertainty).all()
    assert found.left_out < 0.05
    compared = compare(exact, found.mean, noise="auto")
    assert compared.agrees, compared


def test_hum_moves_no_pass():
    """Each has a phase of its own; they differed with p = 1e-19, and so did the mean."""
    rng, found = np.random.default_rng(3), []
    for one in passes("catenary", 3e-3, rng):
        wave = 0.03 * np.sin(2 * np.pi * np.arange(len(one.table)) / 37.3 + rng.uniform(0, 6))
        table = one.table
        for name in CLAMP_READINGS:
            table[name] += wave * table[name].abs().max()
        found.append(replace(one, table=table))
    several = repeats(found)
    assert several.shifts.consistent
    level = compare(exact_sweep("catenary"), several.mean, noise="auto").noise.level
    assert min(level.values()) > 0.03 / np.sqrt(2) / np.sqrt(6) / 2


def test_a_pass_that_is_unlike_the_others_is_named():
    """A sensor that saturates in noise: what is left of the mean agrees, and that is not all."""
    several = [*passes("catenary", 3e-3, np.random.default_rng(2))]
    table = several[4].table
    table["moment_z"] = np.minimum(table["moment_z"], 0.6 * table["moment_z"].max())
    several[4] = replace(several[4], table=table)
    found = repeats(several)
    assert (found.farthest, found.left_out > 0.05) == (4, True)
    said = " ".join(str(getattr(one, "said", "")) for one in repeats_summary(found))
    assert f"most of all {found.names[4]}: left out of their mean" in said


def lacking(one, begin, rows):
    """The pass without some rows."""
    table = one.table.drop(index=range(begin, begin + rows)).reset_index(drop=True)
    return Readings(table, one.beam)


def test_rows_that_some_passes_lack_are_no_gap_of_the_mean():
    """Each lost 32 of 200 somewhere else; rows of the mean were not there."""
    exact, several = exact_sweep("catenary"), passes("catenary", 1e-3, np.random.default_rng(4))
    found = repeats([lacking(one, 20 + 22 * i, 32) for i, one in enumerate(several)])
    compared = compare(exact, found.mean, noise="auto")
    assert not compared.records["candidate"].holes
    assert compared.agrees, compared
    all_lack = [lacking(one, 90, 32) for one in passes("catenary", 1e-3, np.random.default_rng(4))]
    assert compare(exact, repeats(all_lack).mean, noise="auto").records["candidate"].holes


def test_a_pass_of_another_object_is_not_in_the_mean():
    """It made noise of 8e-2, beside which anything agrees."""
    exact, rng = exact_sweep("catenary"), np.random.default_rng(5)
    several, other = [*passes("catenary", 3e-3, rng)], next(passes("parabola", 3e-3, rng))
    foot_x = several[0].values("foot_x")
    rows = {n: np.interp(-foot_x, -other.values("foot_x"), other.values(n)) for n in CLAMP_READINGS}
    another = Readings(several[0].table.assign(**rows), exact.beam, "another")
    found = repeats([*several, another])
    assert found.others == ("another",)
    assert "not in their mean: another" in " ".join(
        str(getattr(one, "said", "")) for one in repeats_summary(found)
    )
    assert max(compare(exact, found.mean, noise="auto").noise.level.values()) < 5e-3


def test_two_passes_alike_are_called_so():
    """Each is half of their difference off the mean: of white noise 1 in 20 pairs had p < 0.01."""
    rng, found = np.random.default_rng(4), []
    for _ in range(5):
        several = [*passes("catenary", 1e-2, rng)]
        found += [repeats(several[i : i + 2]).shifts.chi_square for i in (0, 2, 4)]
    assert 0.3 < np.mean(found) < 1.3
