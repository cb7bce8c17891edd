"""The numerics of a MuJoCo sweep: everything that is not physics."""

from dataclasses import dataclass

from pydantic import ConfigDict, StrictBool, StrictFloat, StrictInt

from analytic.problem.errors import InputError
from mujoco_models.allowed import (
    BEAMS,
    CLAMPS,
    CONTACT_STIFFNESSES,
    OBSTACLES,
    BeamKind,
    ClampKind,
    ObstacleKind,
    check_number,
    check_word,
)


@dataclass(frozen=True)
class Settings:
    """How MuJoCo simulates a case.

    Lengths and stiffnesses are in units of the case: L, EI/L^3 and EI/L.

    Parameters
    ----------
    beam : str
        Which of MuJoCo's models of a slender beam; see `available_beams`.
    segments : int
        Number of segments N, at least 2.
    contour_points : int
        Points of the obstacle's mesh along the contour, at equal steps of slope angle.
    contact_stiffness : float
        Force over penetration of a contact [EI/L^3].
    corner_radius : float
        Of the thin edges that stand for an object's sharp corners [L].
    clamp : str
        Where the beam first bends: half a cell from the clamp, ``"second-order"`` in 1/N, or a
        whole one, ``"naive"`` (first order; for comparison).
    obstacle : str
        The object as a ``"mesh"``, or, if its contour has no corners, as MuJoCo's smooth
        ``"primitive"``: a cylinder that osculates the contour where the vibrissa touches.
    tolerance : float
        A station has settled when no joint is out of balance by more than this [EI/L].
    planar : bool
        Whether the beam stays in the plane of the sweep, as in the theory, or may leave it.

    Raises
    ------
    InputError
        If a number is out of its range.
    """

    __pydantic_config__ = ConfigDict(extra="forbid")  # a misspelt key in a case file is an error

    beam: BeamKind = "chain"
    segments: StrictInt = 40
    contour_points: StrictInt = 3200
    contact_stiffness: StrictFloat = 1e7
    corner_radius: StrictFloat = 1e-6
    clamp: ClampKind = "second-order"
    obstacle: ObstacleKind = "mesh"
    tolerance: StrictFloat = 1e-8
    planar: StrictBool = True

    def __post_init__(self) -> None:
        check_word("mujoco.beam", self.beam, BEAMS)
        check_word("mujoco.clamp", self.clamp, CLAMPS)
        check_word("mujoco.obstacle", self.obstacle, OBSTACLES)
        if not isinstance(self.planar, bool):
            raise InputError(
                "mujoco.planar",
                repr(self.planar),
                "true or false",
                "false lets the beam leave the plane",
            )
        check_number("mujoco.segments", self.segments, 2, 1000, "40 is usual", whole=True)
        points = self.contour_points
        check_number("mujoco.contour_points", points, 8, 50_000, "3200 is usual", whole=True)
        for name, low, high, remedy in (
            ("contact_stiffness", *CONTACT_STIFFNESSES, "1e7 is usual"),
            ("corner_radius", 1e-9, 1e-3, "1e-6 is usual"),
            ("tolerance", 1e-11, 1e-2, "1e-8 is usual"),
        ):
            check_number(f"mujoco.{name}", getattr(self, name), low, high, remedy)
