"""What solves the problem: elliptic integrals, two contact phases, events, reconstruction."""
