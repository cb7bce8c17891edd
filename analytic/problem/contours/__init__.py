"""Convex contours: what every kind of them answers, and the kinds that there are."""
