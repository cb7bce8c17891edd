"""``make bench``: all of it, or the parts named; ``--quick`` only tries them."""

import sys

from tests.bench import (
    analytic_speed,
    engines_speed,
    exudyn_speed,
    mujoco_speed,
    plain_stepping,
    ratios,
    space_speed,
    study_speed,
)

PARTS = {
    "ratios": ratios.main,
    "analytic": analytic_speed.main,
    "mujoco": mujoco_speed.main,
    "space": space_speed.main,
    "stepping": plain_stepping.main,
    "exudyn": exudyn_speed.main,
    "engines": engines_speed.main,
    "study": study_speed.main,
}

if __name__ == "__main__":  # the studies start processes of their own
    asked = [name for name in sys.argv[1:] if name != "--quick"]
    unknown = ", ".join(sorted(set(asked) - set(PARTS)))
    if unknown:
        sys.exit(
            f"bench = {unknown}: must be among {', '.join(PARTS)}; name those, or none for all"
        )
    for name in asked or PARTS:
        PARTS[name]("--quick" in sys.argv)
