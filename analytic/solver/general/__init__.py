"""The vibrissa with friction, an elastic clamp, a natural curvature, and what varies along it."""
