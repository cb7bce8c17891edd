"""What can go wrong in a simulation."""


class DivergedError(ArithmeticError):
    """The simulation is not a number any more."""


class ClampError(ArithmeticError):
    """The clamp's sensors do not read what holds the beam: a defect of the model or of MuJoCo.

    Parameters
    ----------
    foot_x : float
        Foot position of the station [L].
    discrepancy : float
        By how much the sensors differ from contacts and elasticity [EI/L^2, EI/L].
    allowed : float
        How much they may.
    """

    def __init__(self, foot_x: float, discrepancy: float, allowed: float) -> None:
        super().__init__(
            f"at foot_x = {foot_x:.6g} L MuJoCo's clamp sensors differ by {discrepancy:.1e} "
            f"(EI/L^2, EI/L) from what contacts and elasticity require; at most {allowed:g}"
        )
