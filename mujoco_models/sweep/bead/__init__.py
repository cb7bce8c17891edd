"""A planar sweep at rest with one bead, which slides along the beam."""
