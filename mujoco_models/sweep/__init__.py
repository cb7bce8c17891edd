"""From station to station: coming to rest, snapping off, leaving the plane."""
