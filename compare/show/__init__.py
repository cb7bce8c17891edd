"""Pictures, pages and words about sweeps and comparisons."""
