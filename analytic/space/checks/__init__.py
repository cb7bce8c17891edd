"""Slower ways to the same states in space, to test the closed form against."""
