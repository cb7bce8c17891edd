"""The uncertainty is as large as it says: synthetic validations of right models."""

from dataclasses import dataclass

import numpy as np
import pytest

from analytic import CLAMP_READINGS, solve_sweep
from compare import validate
from compare.measure.measurement import measure
from compare.validate.validation import Validation
from tests.compare.validate.experiments import CASES, measured, off, stated

_WINDOW = 5e-3


@dataclass
class Tally:
    """What many validations come to."""

    whole: list[bool]
    readings: list[bool]
    stations: list[float]
    named: list[bool]


def made_of(case, exact, known) -> dict[str, float]:
    """What each uncertainty makes of the mean square, from sweeps with one input off at a time."""
    scale = {n: np.abs(exact.values(n)).max() for n in CLAMP_READINGS}
    made = {"noise": float(np.mean([(known.noise[n] / scale[n]) ** 2 for n in CLAMP_READINGS]))}
    for name, one in known.inputs.items():
        size = []
        for way in (1, -1):
            table = measure(exact, off(case, {name: way * one.standard}), _WINDOW).alignment.table
            away = np.abs(table["at"] - exact.snap_off) > 0.05
            for n in CLAMP_READINGS:
                apart = (table[f"{n}_candidate"] - table[f"{n}_reference"])[away] / scale[n]
                size.append(float(np.mean(apart**2)))
        made[name] = float(np.mean(size))
    return made


def tallied(name: str, count: int, seed: int, dominance: bool = True) -> Tally:
    case, rng = CASES[name], np.random.default_rng(seed)
    exact = solve_sweep(case)
    tally = Tally([], [], [], [])
    for _ in range(count):
        known = stated(case, exact, rng)
        found: Validation = validate(
            measure(exact, measured(case, known, rng), _WINDOW), case, known, samples=4
        )
        tally.whole.append(not found.whole.resolved)
        tally.readings += [not one.resolved for one in found.by_reading.values()]
        tally.stations.append(float(np.mean(np.abs(found.table.error) <= 2 * found.table.u_val)))
        if not dominance:
            continue
        made = made_of(case, exact, known)
        largest = max(made, key=made.__getitem__)
        if made[largest] > 0.6 * sum(made.values()):  # one that dominates without any doubt
            tally.named.append(found.dominant == largest)
    return tally


@pytest.mark.slow
def test_a_right_model_is_mostly_within_its_uncertainty():
    found = tallied("circle", 3, seed=1, dominance=False)
    assert sum(found.whole) >= 2
    assert np.mean(found.stations) > 0.8


@pytest.mark.trial
def test_400_validations_are_within_the_uncertainty_in_95_of_100():
    tallies = [tallied(name, 80, seed) for seed, name in enumerate(CASES)]
    whole, readings, stations, named = (
        np.concatenate([getattr(tally, field) for tally in tallies])
        for field in ("whole", "readings", "stations", "named")
    )
    print(len(whole), whole.mean(), readings.mean(), stations.mean(), len(named), named.mean())
    assert len(whole) == 400
    # 95.45 % are aimed at; 1.04 % is the standard deviation of that share of 400.
    assert 0.93 <= whole.mean() <= 0.97
    assert 0.93 <= readings.mean() <= 0.97
    assert 0.93 <= stations.mean() <= 0.97
    assert len(named) > 100
    assert named.mean() >= 0.95
