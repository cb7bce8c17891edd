"""Who does the runs, and what one run records."""
