"""Numerical tools that know nothing of vibrissae; open to the simulators, too."""
