"""``make bench``: all of it, or the parts named on the command line."""

import sys

from tests.bench import analytic_speed, exudyn_speed, mujoco_speed, plain_stepping, study_speed

PARTS = {
    "analytic": analytic_speed.main,
    "mujoco": mujoco_speed.main,
    "stepping": plain_stepping.main,
    "exudyn": exudyn_speed.main,
    "study": study_speed.main,
}

if __name__ == "__main__":  # the studies start processes of their own
    for name in sys.argv[1:] or PARTS:
        PARTS[name]()
