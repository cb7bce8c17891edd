"""Random trials that are part of the project: `python -m tests.fuzz.NAME`."""
