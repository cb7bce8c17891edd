"""What can go wrong in a simulation."""


class DivergedError(ArithmeticError):
    """The simulation is not a number any more."""
