"""The callers of MuJoCo: the sweeps that a budget needs, and the overview picture."""
