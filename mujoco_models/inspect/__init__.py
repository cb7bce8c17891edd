"""A user's own model: what of it is the vibrissa, and what beam that is."""
