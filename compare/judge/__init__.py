"""Limits, each with its reason, and which of them a measured disagreement exceeds."""
