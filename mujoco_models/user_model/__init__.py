"""A user's own model, swept past the case's object."""
