"""The vibrissa with friction, an elastic clamp and a constant natural curvature."""
