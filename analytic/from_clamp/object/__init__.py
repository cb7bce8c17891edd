"""The object as a whole, from the clamp's readings: a contour with few numbers."""
