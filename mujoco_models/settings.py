"""The numerics of a MuJoCo sweep: everything that is not physics."""

from dataclasses import dataclass
from numbers import Integral, Real
from typing import Literal, TypeAlias, get_args

from pydantic import ConfigDict, StrictBool, StrictFloat, StrictInt

from analytic.problem.errors import InputError

BeamKind: TypeAlias = Literal["chain", "rod", "cable"]
ClampKind: TypeAlias = Literal["second-order", "naive"]
ObstacleKind: TypeAlias = Literal["mesh", "primitive"]
BEAMS, CLAMPS, OBSTACLES = map(get_args, (BeamKind, ClampKind, ObstacleKind))
CONTACT_STIFFNESSES = 1e3, 1e9  # EI/L^3; the least and the largest


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
        for name, allowed in (("beam", BEAMS), ("clamp", CLAMPS), ("obstacle", OBSTACLES)):
            value = getattr(self, name)
            if value not in allowed:
                raise InputError(
                    f"mujoco.{name}", repr(value), f"one of {', '.join(allowed)}", "choose one"
                )
        if not isinstance(self.planar, bool):
            raise InputError(
                "mujoco.planar",
                repr(self.planar),
                "true or false",
                "false lets the beam leave the plane",
            )
        for name, kind, low, high, remedy in (
            ("segments", Integral, 2, 1000, "40 is usual"),
            ("contour_points", Integral, 8, 50_000, "3200 is usual"),
            ("contact_stiffness", Real, *CONTACT_STIFFNESSES, "1e7 is usual"),
            ("corner_radius", Real, 1e-9, 1e-3, "1e-6 is usual"),
            ("tolerance", Real, 1e-11, 1e-2, "1e-8 is usual"),
        ):
            value = getattr(self, name)
            is_number = isinstance(value, kind) and not isinstance(value, bool)
            if not (is_number and low <= value <= high):
                number = "a whole number" if kind is Integral else "a number"
                raise InputError(
                    f"mujoco.{name}", value, f"{number} between {low:g} and {high:g}", remedy
                )
