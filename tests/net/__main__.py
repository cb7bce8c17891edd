"""``make OUT [--only ROOM] [--jobs N]`` or ``compare OLD NEW [--tolerance T]``."""

import argparse
import os
import sys
from pathlib import Path

for library in ("OMP", "OPENBLAS", "MKL"):  # sums depend on how many threads share them
    os.environ[f"{library}_NUM_THREADS"] = "1"
if not __package__:  # run by its path: what is swept is the checkout that it is run in
    sys.path[0] = str(Path.cwd())
    sys.path.append(str(Path(__file__).resolve().parents[1]))
    __package__ = "net"


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.net", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    make = commands.add_parser("make", help="sweep, and store")
    make.add_argument("out", type=Path)
    make.add_argument("--only", metavar="ROOM", default="*", help="or a pattern of ROOM/NAME")
    make.add_argument("--jobs", type=int, default=2)
    compare = commands.add_parser("compare", help="two stored sets; exit code 1 if any differs")
    compare.add_argument("old", type=Path)
    compare.add_argument("new", type=Path)
    compare.add_argument("--tolerance", type=float, default=1e-12)
    asked = parser.parse_args()
    if asked.command == "make":
        from .making import make_all

        return make_all(asked.out.resolve(), asked.only, asked.jobs)
    from .difference import compare_sets

    return compare_sets(asked.old, asked.new, asked.tolerance)


if __name__ == "__main__":
    sys.exit(main())
