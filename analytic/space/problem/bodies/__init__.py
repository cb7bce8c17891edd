"""Convex bodies in space."""
