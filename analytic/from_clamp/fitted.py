"""What a fit of an object has found, and the likeliest of several families."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from analytic.from_clamp.calibration.calibrate import Estimate
from analytic.from_clamp.correlated import NoiseFound, likelihood
from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError, unknown
from analytic.problem.shown import Shown

_DECISIVE = 10.0  # of Schwarz's criterion (Kass and Raftery 1995)
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
    by_noise : array, shape (noises, channels)
        Logarithm of the readings' probability for each noise that they may have.
    penalty : float
        Of Schwarz's criterion, for the parameters.
    stations : int
        How many the fit is from.
    noise : NoiseFound
        What of the noise remembers.
    judged : bool
        Whether what the fit leaves can be judged: of noise that remembers and is not stated, only
        stations off the contact show the size.
    rivals : dict
        Of each family that was tried Schwarz's criterion, for the noise that the likeliest shows,
        and whether it explains the readings; no family does that is worse by more than 10, but for
        one that fits them as well with more parameters.
    """

    family: str
    found: dict[str, Estimate]
    misfit: float
    explains: bool
    by_noise: Floats
    penalty: float
    stations: int
    noise: NoiseFound
    judged: bool
    rivals: dict[str, tuple[float, bool]] = field(default_factory=dict)

    @property
    def bic(self) -> float:
        """Schwarz's criterion: the least of several families is the likeliest."""
        return self.penalty - 2 * likelihood(self.by_noise)

    @property
    def others(self) -> list[str]:
        """The families beside it that explain the readings, too."""
        return [name for name, (_, good) in self.rivals.items() if good and name != self.family]

    def _tiles(self) -> dict[str, object]:
        too = f", as {' and '.join(self.others)} do" if self.others else ""
        return {
            self.family: f"explains the readings{too}"
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
    likely = _criteria(found)
    good = {one.family: one.explains and not _refuted(one, found, likely) for one in found}
    explaining = [one for one in found if good[one.family]]
    unsure = [one for one in found if not one.judged and not _refuted(one, found, likely)]
    if family == "auto" and not explaining and not unsure:
        best = ""
        if found:
            left = min(one.misfit for one in found)
            best = f", the best leaves {left:.3g} times the noise"
            if left < _AS_NOISE:
                best = ", what the best leaves is too much alike along the sweep for noise"
        why = f"likely {otherwise}; of a simulator's readings, state its error as noise"
        if refused:
            why = f"of {len(refused)} others the last says: {refused[-1]}; or {why}"
        raise NoFamilyError("family", f"none of them{best}", "one that explains the readings", why)
    rivals = {name: (bic, good[name]) for name, bic in likely.items()}
    return replace(
        min(explaining or unsure or found, key=lambda one: likely[one.family]), rivals=rivals
    )


def _refuted(one: Fitted, found: Sequence[Fitted], likely: Mapping[str, float]) -> bool:
    """Whether the likeliest family is so by far, and not by its fewer numbers alone."""
    best = min(found, key=lambda other: likely[other.family])
    more = likely[one.family] - likely[best.family]
    return more >= _DECISIVE and more > one.penalty - best.penalty


def _criteria(found: Sequence[Fitted]) -> dict[str, float]:
    """Schwarz's criterion of each, for the noise that one of them shows.

    That is the likeliest one if the noise is white: what a wrong object leaves looks like noise
    that remembers, by which it would be excused.
    """
    if not found:
        return {}
    seen = min(found, key=lambda one: one.penalty - 2 * one.by_noise[0].sum()).by_noise
    return {one.family: one.penalty - 2 * likelihood(one.by_noise, seen) for one in found}
