"""What a fit of an object has found, and the likeliest of several families."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from analytic.from_clamp.calibration.calibrate import Estimate
from analytic.from_clamp.correlated import NoiseFound
from analytic.problem.errors import InputError, unknown
from analytic.problem.shown import Shown

_AS_NOISE = 1.2  # times the noise; less does not show a wrong object

Kind = TypeVar("Kind", bound="Fitted")


@dataclass(frozen=True, repr=False, kw_only=True)
class Fitted(Shown):
    """An object of a family: `FittedObject` in the plane, `FittedBody` in space.

    Parameters
    ----------
    family : str
        As it was asked for, or the likeliest.
    found : dict
        `Estimate` by parameter, in the unit of the readings.
    misfit : float
        Root mean square of what the fit leaves, over the noise.
    explains : bool
        Whether noise alone explains that.
    bic : float
        Schwarz's criterion: the least of several families is the likeliest.
    stations : int
        How many the fit is from.
    noise : NoiseFound
        What of the noise remembers.
    rivals : dict
        `bic` and `explains` of each family that was tried.
    """

    family: str
    found: dict[str, Estimate]
    misfit: float
    explains: bool
    bic: float
    stations: int
    noise: NoiseFound
    rivals: dict[str, tuple[float, bool]] = field(default_factory=dict)

    def _tiles(self) -> dict[str, object]:
        return {
            self.family: "explains the readings"
            if self.explains
            else "does not explain the readings",
            **self.found,
            "misfit": f"{self.misfit:.3g}",
            "stations": self.stations,
        }


def check_family(family: str, known: Sequence[str]) -> None:
    if family not in (*known, "auto"):
        raise unknown("family", family, (*known, "auto"))


class NoFamilyError(InputError):
    """No family explains the readings, which may be right for all else."""


def likeliest(
    family: str, known: Sequence[str], fit: Callable[[str], Kind], otherwise: str
) -> Kind:
    """The fit of a family; with ``"auto"`` that of the least Schwarz criterion that explains all.

    If none does, `otherwise` is what the object likely has, unless some could not be fitted.
    """
    found, refused = [], []
    for name in known if family == "auto" else [family]:
        try:
            found.append(fit(name))
        except InputError as error:  # as one that the readings do not determine
            if family != "auto":
                raise
            refused.append(str(error))
    explaining = [one for one in found if one.explains]
    if family == "auto" and not explaining:
        best = ""
        if found:
            least = min(one.misfit for one in found)
            best = f", the best leaves {least:.3g} times the noise"
            if least < _AS_NOISE:
                best = ", what the best leaves is too much alike along the sweep for noise"
        why = f"likely {otherwise}; of a simulator's readings, state its error as noise"
        if refused:
            why = f"of {len(refused)} others the last says: {refused[-1]}; or {why}"
        raise NoFamilyError("family", f"none of them{best}", "one that explains the readings", why)
    rivals = {one.family: (one.bic, one.explains) for one in found}
    return replace(min(explaining or found, key=lambda one: one.bic), rivals=rivals)
