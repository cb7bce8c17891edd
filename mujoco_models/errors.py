"""What can go wrong in a simulation."""

from analytic.problem.clamp_path import Pose


class DivergedError(ArithmeticError):
    """The simulation is not a number any more."""


class ClampError(ArithmeticError):
    """The clamp's sensors do not read what holds the beam: a defect of the model or of MuJoCo.

    Parameters
    ----------
    pose : Pose
        Of the clamp at the station [L, rad].
    discrepancy : float
        By how much the sensors differ from contacts and elasticity [EI/L^2, EI/L].
    allowed : float
        How much they may.
    """

    def __init__(self, pose: Pose, discrepancy: float, allowed: float) -> None:
        super().__init__(
            f"with the foot at x = {pose.foot_x:.6g}, y = {pose.foot_y:.6g} L and the clamp at "
            f"{pose.angle:.6g} rad MuJoCo's clamp sensors differ by {discrepancy:.1e} "
            f"(EI/L^2, EI/L) from what contacts and elasticity require; at most {allowed:g}"
        )
