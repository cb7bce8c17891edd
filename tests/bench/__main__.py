"""``make bench``: all of it, or the parts named on the command line."""

import sys

from tests.bench import analytic_speed

PARTS = {"analytic": analytic_speed.main}

for name in sys.argv[1:] or PARTS:
    PARTS[name]()
