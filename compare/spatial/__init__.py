"""Two sweeps in space set against each other: measured, judged and split into causes."""
