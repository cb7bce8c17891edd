"""``make bench``: all that is not long, or the parts named; ``--quick`` only tries them.

``limits``: how far each figure is from what it cannot go below; ``ratios``: whether anything has
become dearer, an entry of the history; ``analytic``: contacts a second, against shooting and
collocation, and memory; ``mujoco``: time a station against segments and contour points, with the
error; ``space``: oblique ways past files; ``stepping``: plain time stepping to the same balance.
"""

import sys

from tests.bench import (
    analytic_speed,
    limits,
    models_speed,
    plain_stepping,
    ratios,
    space_speed,
    study_speed,
)

PARTS = {
    "ratios": ratios.main,
    "limits": limits.main,
    "analytic": analytic_speed.main,
    "mujoco": models_speed.beams,
    "space": space_speed.main,
    "stepping": plain_stepping.main,
    "engines": models_speed.engines,
    "study": study_speed.main,
}
LONG = {"million": analytic_speed.million}
"""Half an hour of one core or more: only if asked for by name."""

if __name__ == "__main__":  # the studies start processes of their own
    asked = [name for name in sys.argv[1:] if name != "--quick"]
    unknown = ", ".join(sorted(set(asked) - {*PARTS, *LONG}))
    if unknown:
        sys.exit(
            f"bench = {unknown}: must be among {', '.join([*PARTS, *LONG])}; "
            f"name those, or none for all but {', '.join(LONG)}"
        )
    for name in asked or PARTS:
        (PARTS | LONG)[name]("--quick" in sys.argv)
