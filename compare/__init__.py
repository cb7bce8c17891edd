"""How far two sweeps disagree, and why."""
