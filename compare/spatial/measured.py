"""What two sweeps in space differ by, before it is judged."""

from dataclasses import dataclass
from typing import Any

from analytic.problem.arrays import Booleans, Floats
from analytic.space import SpatialReadings
from compare.align.frames import Frame
from compare.judge.spatial import SpatialTolerances
from compare.measure.disagreement import Occurrence
from compare.spatial.noise import SpatialNoise, Touching


@dataclass(frozen=True)
class ComponentDisagreement:
    """How far one component of the candidate is off, over the largest of its kind."""

    rms: float  # over the compared stations; NaN if there are none
    max: float  # over the compared stations; NaN if there are none
    at: float  # way of the foot where it is largest [length]
    phase: str  # the reference's phase there
    rms_by_phase: dict[str, float]  # by the reference's phases
    scale: float  # the reference's largest component of force, or of moment, in the readings' unit


@dataclass(frozen=True, eq=False)
class ContactDisagreement:
    """How far the contact points are apart [L], at the stations where both are known."""

    rms: float  # naN if there is no such station
    max: float  # naN if there is no such station
    stations: int  # how many there are
    asked: int  # at how many both touch with a force that noise cannot hide
    # The sources that record no contacts: theirs are reconstructed from the clamp.
    from_clamp: tuple[str, ...]
    distance: Floats  # shape (stations,); Of each station of the sweeps; NaN where it is not known

    def to_dict(self) -> dict[str, Any]:
        """What ``comparison.json`` holds."""
        return {name: value for name, value in vars(self).items() if name != "distance"}


@dataclass(frozen=True, eq=False, repr=False)
class SpatialMeasurement:
    """How far a candidate is off, and how far it may be.

    Attributes
    ----------
    reference, candidate : SpatialReadings
        The two.
    frame : {"world", "clamp"}
        Of the components.
    travel : array, shape (stations,)
        Way of the foot [length].
    compared : array of bool, shape (stations,)
        Where both touch and are trusted.
    disagreement : dict of ComponentDisagreement
        By component, ``"force_x"`` to ``"moment_z"``.
    contact : ContactDisagreement
        Between the contact points.
    phase_agreement : float or None
        Share of the compared stations that are in one phase; None where a source records none.
    events : dict of Occurrence
        Way of the foot to each touch, slip-off and release, in both sweeps [length].
    statuses : dict of dict
        How many stations have which status, of the ``"reference"`` and of the ``"candidate"``.
    untrusted : int
        Stations of the candidate without readings where the reference has them.
    tolerances : SpatialTolerances
        Limits.
    noise : SpatialNoise
        What noise adds to them.
    touching : Touching
        Stations that touch.
    """

    reference: SpatialReadings
    candidate: SpatialReadings
    frame: Frame
    travel: Floats
    compared: Booleans
    disagreement: dict[str, ComponentDisagreement]
    contact: ContactDisagreement
    phase_agreement: float | None
    events: dict[str, Occurrence]
    statuses: dict[str, dict[str, int]]
    untrusted: int
    tolerances: SpatialTolerances
    noise: SpatialNoise
    touching: Touching
