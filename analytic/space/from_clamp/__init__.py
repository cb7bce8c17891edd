"""Back from the clamp's six components to the body."""
