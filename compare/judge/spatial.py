"""How far two sweeps in space may disagree, with the reason for every limit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING

from analytic import InputError
from compare.align.frames import COMPONENTS
from compare.judge.tolerances import CONVENTION, Limit, as_limit

if TYPE_CHECKING:  # limits are checked before pandas is needed
    from analytic.space import SpatialReadings

_KINDS = ("rms", "max")


@dataclass(frozen=True)
class SpatialTolerances:
    """Limits of agreement; the defaults are for a chain of 40 segments against the closed form.

    Plain numbers become `Limit` whose reason is that the caller asked for them.

    Parameters
    ----------
    rms : float
        Of each component over all compared stations, relative to the largest component of force or
        of moment.
    max : float
        The same at any one station.
    contact : float
        Of the contact point, root mean square [L].
    event : float
        Of the foot's way to where the vibrissa touches and where it leaves [L].
    phase_agreement : float
        Share of the compared stations that are in one phase.
    untrusted : float
        Share of the stations without readings that the reference has.
    special : mapping
        Limits for one component, by dotted name: ``"force_x.rms"``, ``"moment_z.max"``.

    Raises
    ------
    InputError
        If a limit is no finite number of zero or more, or a special name is unknown.
    """

    rms: float = Limit(
        3e-3, "forty segments reach 1e-4 to 1e-3 past smooth bodies, a coarse mesh three times that"
    )
    max: float = Limit(
        3e-2, "ten times the rms, for stations beside an edge, a change of phase or the slip-off"
    )
    contact: float = Limit(2e-3, "what forty segments reconstruct to")
    event: float = Limit(5e-3, "half a station of two hundred on a way of 2 L")
    phase_agreement: float = Limit(0.95, "the stations beside a change of phase")
    untrusted: float = Limit(5e-3, "one station of 200 may fail to settle")
    special: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in GENERAL_IN_SPACE:
            object.__setattr__(self, name, as_limit(name, getattr(self, name)))
        for name in self.special:
            component, _, kind = name.partition(".")
            if component not in COMPONENTS or kind not in _KINDS:
                raise InputError(
                    f"tolerances.{name}",
                    "unknown",
                    f"COMPONENT.KIND, a component of {', '.join(COMPONENTS)}, a kind of "
                    f"{', '.join(_KINDS)}",
                    "correct the name",
                )
        special = {name: as_limit(name, value) for name, value in self.special.items()}
        object.__setattr__(self, "special", special)

    def of(self, component: str, kind: str) -> Limit:
        """The limit of a component: its own if there is one.

        Parameters
        ----------
        component : str
            As ``"force_x"``.
        kind : str
            ``"rms"`` or ``"max"``.

        Returns
        -------
        Limit
            With its reason.
        """
        return as_limit(kind, self.special.get(f"{component}.{kind}", getattr(self, kind)))

    def limits(self) -> dict[str, Limit]:
        """All limits by name, the special ones by their dotted names.

        Returns
        -------
        dict of Limit
            Each with its reason.
        """
        named = {name: getattr(self, name) for name in GENERAL_IN_SPACE} | dict(self.special)
        return {name: as_limit(name, value) for name, value in named.items()}

    def remark(self, candidate: SpatialReadings) -> str | None:
        """What is to be known of these limits for a source.

        Parameters
        ----------
        candidate : SpatialReadings
            Whoever made it.

        Returns
        -------
        str or None
            That defaults are a convention, for a source that does not record its segments.
        """
        settings = candidate.provenance.get("settings")
        if isinstance(settings, Mapping) and "segments" in settings:
            return None
        given = self.limits()
        usual = [name for name in GENERAL_IN_SPACE if given[name].reason == _reason_of(name)]
        return CONVENTION if usual else None


GENERAL_IN_SPACE = tuple(f.name for f in fields(SpatialTolerances) if f.name != "special")
"""Names of the limits that hold for every component."""


def _reason_of(name: str) -> str:
    reason: str = getattr(SpatialTolerances, name).reason
    return reason
