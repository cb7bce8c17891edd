"""The columns of a sweep's readings: their names, units and signs, and the words in two of them."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats

if TYPE_CHECKING:
    from analytic.problem.beam import Beam

CLAMP_READINGS = ("force_x", "force_y", "moment_z")
SENSED = ("foot_x", *CLAMP_READINGS)
CONTACT = ("contact_angle", "contact_arc_length", "contact_x", "contact_y", "tip_angle")
PHASES = ("free", "tip", "tangent")
STATUSES = (
    "ok",
    "unsettled",
    "diverged",
    "unreachable",
    "chattering",
    "lost",
    "touches again",
    "touches another",
    "sticks",
    "creeping",
)
SECOND_CONTACT = (
    "second_contact_force",
    "second_contact_angle",
    "second_contact_arc_length",
    "second_contact_x",
    "second_contact_y",
)
"""What readings have besides where a vibrissa touches in two places, of the one nearer its tip."""
COLUMNS = (*SENSED, "phase", *CONTACT, "status")
WORDS = {"phase": PHASES, "status": STATUSES}  # the columns of words, with what may stand in them
PHASE_NUMBER = {word: number for number, word in enumerate(PHASES)}
STATUS_NUMBER = {word: number for number, word in enumerate(STATUSES)}


IN_SPACE = ("force_z", "moment_x", "moment_y")  # which no sweep in the plane has


class Column(NamedTuple):
    dimension: Literal["length", "force", "moment", "force/length", "angle"]
    odd: bool = False  # changes its sign in a mirror, x to -x


SCHEMA = {
    **dict.fromkeys(("foot_x", "contact_x", "second_contact_x"), Column("length", odd=True)),
    **dict.fromkeys(("force_x", "force_x_raw"), Column("force", odd=True)),
    **dict.fromkeys(("force_y", "force_y_raw"), Column("force")),
    **dict.fromkeys(("moment_z", "moment_z_raw"), Column("moment", odd=True)),
    **dict.fromkeys(
        ("contact_angle", "second_contact_angle", "clamp_angle"), Column("angle", odd=True)
    ),
    "tip_angle": Column("angle"),  # a mirror takes it from pi
    **dict.fromkeys(("contact_arc_length", "contact_y"), Column("length")),
    **dict.fromkeys(("penetration", "out_of_plane"), Column("length")),
    **dict.fromkeys(("second_contact_arc_length", "second_contact_y"), Column("length")),
    "second_contact_force": Column("force"),
    "residual": Column("moment"),
    "sideways_stiffness": Column("force/length"),
    # In space only, where there is no such mirror.
    **dict.fromkeys(("travel", "foot_y", "foot_z", "contact_z"), Column("length")),
    **dict(zip(IN_SPACE, (Column("force"), Column("moment"), Column("moment")), strict=True)),
}
"""What has a unit or a sign; all other columns are plain numbers that a mirror leaves alone."""
ODD = tuple(name for name, column in SCHEMA.items() if column.odd)


def units(beam: "Beam", names: Iterable[str]) -> Floats:
    """What dimensionless columns are multiplied by, for L = EI = 1 to be a beam's units."""
    sizes = {
        "length": beam.length,
        "force": beam.force_unit,
        "moment": beam.moment_unit,
        "force/length": beam.force_unit / beam.length,
        "angle": 1.0,
    }
    return np.array([sizes[SCHEMA[name].dimension] if name in SCHEMA else 1.0 for name in names])
