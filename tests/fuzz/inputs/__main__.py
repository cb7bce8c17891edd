"""``python -m tests.fuzz.inputs N SEED``."""

import argparse
import sys

import tests.fuzz.inputs
from tests.fuzz.inputs.campaign import campaign, trial
from tests.fuzz.inputs.trial import perform


def _main() -> int:
    parser = argparse.ArgumentParser(description=tests.fuzz.inputs.__doc__)
    parser.add_argument("count", type=int, nargs="?", default=1000)
    parser.add_argument("seed", type=int, nargs="?", default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first trial")
    parser.add_argument("--only", type=int, help="repeat this trial, and print it")
    parser.add_argument("--show", action="store_true", help="a line for each trial")
    given = parser.parse_args()
    if given.only is not None:
        return _repeat(given.seed, given.only)
    numbers = range(given.first, given.first + given.count)
    counts, bad = campaign(numbers, given.seed, given.show)
    for (kind, code), count in sorted(counts.items()):
        print(f"{kind:10}{code:>22}{count:8}")
    print(f"{given.count} trials, {len(bad)} of them ended badly")
    return 1 if bad else 0


def _repeat(seed: int, number: int) -> int:
    made = trial(seed, number)
    for name, content in made.files.items():
        print(f"--- {name}\n{content[:2000]!r}")
    print("vibrissa", *(ascii(word) for word in made.words))
    outcome = perform(made)
    print(outcome.code, outcome.faults, f"{outcome.seconds:.1f} s", outcome.error, sep="\n")
    return 1 if outcome.faults else 0


if __name__ == "__main__":
    sys.exit(_main())
