"""A million sweeps in closed form to the end, in flat memory."""

import resource
import sys
import time

from analytic import Readings, solve_sweeps
from tests.bench.analytic_speed import varied

COUNT = 1_000_000
_MIB = 2**20 if sys.platform == "darwin" else 2**10  # the unit of `ru_maxrss`


def main(quick: bool) -> None:
    """Print what they have taken so far after 10^2, 10^3 and so on."""
    count = COUNT // 10_000 if quick else COUNT
    begin, following, snap_offs = time.process_time(), 100, 0
    for done, found in enumerate(solve_sweeps(varied(count)), 1):
        assert isinstance(found, Readings), found
        snap_offs += found.snap_off is not None
        if done == following:
            taken = time.process_time() - begin
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / _MIB
            print(
                f"{done:,} sweeps, {snap_offs:,} of them with a snap-off: {taken:,.1f} s of one "
                f"core, {1e3 * taken / done:.2f} ms each; {peak:.0f} MiB at the most so far",
                flush=True,
            )
            following *= 10
