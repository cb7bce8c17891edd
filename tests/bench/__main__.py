"""``make bench``: all, or the parts named; ``--quick`` only tries them.

``ratios``: whether anything has become dearer, an entry of the history; ``analytic``: contacts,
sweeps and a command; ``mujoco``: time a station against segments and contour points, with the
error; ``stepping``: plain time stepping to the same balance; ``engines``: the others.
"""

import sys

from tests.bench import analytic_speed, models_speed, plain_stepping, ratios

PARTS = {
    "ratios": ratios.main,
    "analytic": analytic_speed.main,
    "mujoco": models_speed.beams,
    "stepping": plain_stepping.main,
    "engines": models_speed.engines,
}

if __name__ == "__main__":
    asked = [name for name in sys.argv[1:] if name != "--quick"]
    unknown = ", ".join(sorted(set(asked) - {*PARTS}))
    if unknown:
        sys.exit(f"bench = {unknown}: must be among {', '.join(PARTS)}; or name none for all")
    for name in asked or PARTS:
        PARTS[name]("--quick" in sys.argv)
