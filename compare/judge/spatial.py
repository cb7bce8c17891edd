"""How far two sweeps in space may disagree, with the reason for every limit."""

from __future__ import annotations

from dataclasses import dataclass

from compare.align.frames import COMPONENTS
from compare.judge.tolerances import KINDS, Limit, Limits


@dataclass(frozen=True)
class SpatialTolerances(Limits):
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
        Of the foot's travel to where the vibrissa touches and where it leaves [L].
    phase_agreement : float
        Fraction of the compared stations that are in one phase.
    untrusted : float
        Fraction of the stations without readings that the reference has.
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
    _SPECIAL = tuple(f"{name}.{kind}" for name in COMPONENTS for kind in KINDS)
