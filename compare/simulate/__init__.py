"""The callers of MuJoCo: the sweeps that a budget needs, and what a user's model is."""
