"""Many trials, counted."""

from collections import Counter
from collections.abc import Iterable

import numpy as np

from tests.fuzz.inputs import data, meshes, models, tables, words
from tests.fuzz.inputs.dice import Dice
from tests.fuzz.inputs.trial import Trial, perform

KINDS = {
    words.options: 4, tables.case: 5, tables.study: 4, data.data: 5, meshes.mesh: 3,
    words.written: 2, tables.toml: 1, models.model: 2, models.rig: 2,
}  # fmt: skip
"""Makers of trials, and how often each is asked."""


def trial(seed: int, number: int) -> Trial:
    """The trial of that number; a function of seed and number alone."""
    dice, weights = Dice(seed, number), np.array([*KINDS.values()])
    return [*KINDS][dice.rng.choice(len(weights), p=weights / weights.sum())](dice)


def campaign(numbers: Iterable[int], seed: int, show: bool = False) -> tuple[Counter, list[str]]:
    """Do trials; counts by class and exit code, and a line for each that ended badly."""
    counts: Counter = Counter()
    bad = []
    for number in numbers:
        made = trial(seed, number)
        outcome = perform(made)
        counts[made.kind, str(outcome.code)[:20]] += 1
        if outcome.faults:
            bad.append(f"{number} {made.kind}: {'; '.join(outcome.faults)}: {made}"[:400])
        for name, content in made.files.items() if show else ():
            print(f"--- {name}\n{content[:2000]!r}")
        if outcome.faults or show:
            print(number, made.kind, outcome.code, f"{outcome.seconds:.1f} s", made)
            print(f"    {outcome.error[-300:]!a}", *outcome.faults, sep="; ", flush=True)
        if number % 500 == 499:
            print(f"{counts.total()} done, the last is number {number}", flush=True)
    return counts, bad
