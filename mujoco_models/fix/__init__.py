"""Edits of a user's model file that leave all else of its text as it is."""
