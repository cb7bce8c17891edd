"""The problem in space: a vibrissa, a convex body, and the way of the foot."""
