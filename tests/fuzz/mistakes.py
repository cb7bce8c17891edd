"""Mistakes of a rig or a simulator, planted in random sweeps: how often each is named rightly.

``python -m tests.fuzz.mistakes SEEDS [FIRST]`` prints a row a mistake: how often its own name was
given, how often none, and which wrong ones. Every sweep is past a contour of its own, with the
smooth error that a chain has and white noise of up to 0.5 %.
"""

import sys
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import pandas as pd

from analytic import (
    CLAMP_READINGS,
    SENSED,
    Case,
    InputError,
    Readings,
    Sweep,
    catenary,
    circle,
    ellipse,
    parabola,
    solve_sweep,
    two_circles,
)
from compare import compare
from compare.sense.noise import with_noise
from tests.fuzz.acts import with_own_error
from tests.fuzz.planted import MISTAKES, Mistake

_OWN_ERROR = (3e-4, 1.2e-3)  # of a reading's largest magnitude: a chain of 40 segments and more
_NOISE = 5e-3


def random_case(rng: np.random.Generator) -> Case:
    """A smooth contour, and a sweep past it."""
    height = rng.uniform(0.35, 0.65)
    contour = (
        lambda: catenary(rng.uniform(0.3, 1.0), height - 1),
        lambda: parabola(rng.uniform(0.2, 1.0), height),
        lambda: circle(rng.uniform(0.3, 2.0), (0.0, height)),
        lambda: ellipse((rng.uniform(0.5, 2.0), rng.uniform(0.5, 1.5)), (0.0, height)),
        lambda: two_circles(rng.uniform(0.5, 2.0), rng.uniform(0.5, 2.0), (0.0, height)),
    )[rng.integers(5)]
    return Case(profile=contour(), sweep=Sweep(int(rng.integers(100, 260))))


def named(mistake: Mistake, seed: int) -> str | None:
    """What the comparison calls a mistake planted at random; None if it names nothing."""
    rng = np.random.default_rng(seed)
    while True:
        case = replace(random_case(rng), **mistake.stated)
        reference = solve_sweep(case)
        try:
            sweep = reference if mistake.swept is None else mistake.swept(case, rng)
            break
        except InputError:  # the vibrissa as it really is does not come past that object
            continue
    sweep = with_own_error(sweep, rng, rng.uniform(*_OWN_ERROR))
    noise = dict.fromkeys(CLAMP_READINGS, float(rng.uniform(0, _NOISE)) * rng.integers(2))
    if mistake.sensed is not None:
        sweep = mistake.sensed(sweep, rng)
    sweep = with_noise(sweep, noise, seed)
    if mistake.recorded is not None:
        sweep = mistake.recorded(sweep, rng)
    candidate = Readings(sweep.table[list(SENSED)], case.beam, "rig")
    found = compare(reference, candidate)
    return found.likely or "; ".join(found.records["candidate"].defects()) or None


def confusion(seeds: Iterable[int]) -> pd.DataFrame:
    """A row a mistake: how often it was named rightly, not at all, and wrongly, and as what."""
    rows = []
    for kind, mistake in MISTAKES.items():
        right, silent, wrong = 0, 0, Counter[str]()
        for seed in seeds:
            said = named(mistake, seed)
            if said is None:
                silent += 1
            elif mistake.named and all(word in said for word in mistake.named.split(" & ")):
                right += 1
            else:
                wrong[f"{seed}: {said[:60]}"] += 1
        print(f"{kind}: {right} right, {silent} silent", file=sys.stderr, flush=True)
        rows.append((kind, right, silent, wrong.total(), "; ".join(wrong)))
    return pd.DataFrame(rows, columns=["mistake", "right", "silent", "wrong", "as"])


def main() -> None:
    """Print the table, and the shares."""
    seeds, first = (*map(int, sys.argv[1:]), *(10, 0)[len(sys.argv) - 1 :])
    table = confusion(range(first, first + seeds))
    print(table.to_string(index=False, max_colwidth=None))
    known = [mistake.must for mistake in MISTAKES.values()]
    trials = seeds * sum(known)
    print(f"named rightly: {table[known]['right'].sum() / trials:.1%} of {trials}")
    print(
        f"named wrongly: {table['wrong'].sum() / (seeds * len(table)):.1%} of {seeds * len(table)}"
    )


if __name__ == "__main__":
    main()
