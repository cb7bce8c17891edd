"""Two sweeps brought to the same origin and to the same stations."""
