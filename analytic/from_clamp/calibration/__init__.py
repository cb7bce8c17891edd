"""What a vibrissa is, from a sweep past an object that is known."""
