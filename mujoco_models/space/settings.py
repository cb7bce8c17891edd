"""The numerics of a MuJoCo sweep in space: everything that is not physics."""

from dataclasses import dataclass
from numbers import Integral, Real
from typing import Literal, TypeAlias, get_args

from pydantic import ConfigDict, StrictFloat, StrictInt

from analytic.problem.errors import InputError
from mujoco_models.settings import CONTACT_STIFFNESSES, ClampKind

SpatialBeamKind: TypeAlias = Literal["chain", "rod"]
JointKind: TypeAlias = Literal["ball", "universal"]
_WORDS = {
    "beam": get_args(SpatialBeamKind),
    "joints": get_args(JointKind),
    "clamp": get_args(ClampKind),
}


@dataclass(frozen=True)
class SpatialSettings:
    """How MuJoCo simulates a case in space.

    Stiffnesses and moments are in units of the case: EI/L^3 and EI/L.

    Parameters
    ----------
    beam : str
        Rigid links with springs, ``"chain"``, or MuJoCo 4's one-dimensional flex, ``"rod"``.
    joints : str
        Of the links: a ``"ball"`` bends alike in all directions and twists, with GJ = EI; a
        ``"universal"`` joint, two hinges, does not twist. The rod has universal joints only.
    segments : int
        Number of segments N, at least 2.
    contact_stiffness : float
        Force over penetration of the contact [EI/L^3].
    clamp : str
        Where the beam first bends: half a cell from the clamp, ``"second-order"`` in 1/N, or a
        whole one, ``"naive"`` (first order; for comparison).
    contour_points : int
        Points of a prism's mesh along its contour, at equal steps of slope angle; about as many
        points has a body that is stated by its support function.
    tolerance : float
        A station has settled when no joint is out of balance by more than this [EI/L].

    Raises
    ------
    InputError
        If a word is unknown, or a number out of its range.
    """

    __pydantic_config__ = ConfigDict(extra="forbid")  # a misspelt key in a case file is an error

    beam: SpatialBeamKind = "chain"
    joints: JointKind = "ball"
    segments: StrictInt = 40
    contact_stiffness: StrictFloat = 1e7
    clamp: ClampKind = "second-order"
    contour_points: StrictInt = 3200
    tolerance: StrictFloat = 1e-8

    def __post_init__(self) -> None:
        for name, allowed in _WORDS.items():
            value = getattr(self, name)
            if value not in allowed:
                raise InputError(
                    f"mujoco.{name}", repr(value), f"one of {', '.join(allowed)}", "choose one"
                )
        if self.beam == "rod" and self.joints != "universal":
            raise InputError(
                "mujoco.joints",
                repr(self.joints),
                "'universal' for the rod",
                "a one-dimensional flex cannot resist twisting",
            )
        for name, kind, low, high, remedy in (
            ("segments", Integral, 2, 400, "40 is usual"),
            ("contact_stiffness", Real, *CONTACT_STIFFNESSES, "1e7 is usual"),
            ("contour_points", Integral, 8, 20_000, "3200 is usual"),
            ("tolerance", Real, 1e-10, 1e-2, "1e-8 is usual"),
        ):
            value = getattr(self, name)
            is_number = isinstance(value, kind) and not isinstance(value, bool)
            if not (is_number and low <= value <= high):
                number = "a whole number" if kind is Integral else "a number"
                raise InputError(
                    f"mujoco.{name}", value, f"{number} between {low:g} and {high:g}", remedy
                )
