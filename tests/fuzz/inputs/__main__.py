"""``python -m tests.fuzz.inputs N SEED``."""

import argparse
import sys

import tests.fuzz.inputs
from tests.fuzz.inputs.campaign import campaign


def _main() -> int:
    parser = argparse.ArgumentParser(description=tests.fuzz.inputs.__doc__)
    parser.add_argument("count", type=int, nargs="?", default=1000)
    parser.add_argument("seed", type=int, nargs="?", default=1)
    parser.add_argument("--only", type=int, help="repeat this trial, and print it")
    given = parser.parse_args()
    numbers = range(given.count) if given.only is None else [given.only]
    counts, bad = campaign(numbers, given.seed, show=given.only is not None)
    for (kind, code), count in sorted(counts.items()):
        print(f"{kind:10}{code:>22}{count:8}")
    print(f"{counts.total()} trials, {len(bad)} of them ended badly")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(_main())
