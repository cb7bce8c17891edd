"""What was measured of a user's model; plain numbers, in the model's own units."""

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.shown import Shown
from mujoco_models.inspect.drive import Rail, Reach
from mujoco_models.inspect.hand import Hand
from mujoco_models.motion import ConeKind, IntegratorKind

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class Sensed:
    """A sensor at the clamp."""

    name: str  # the sensor's
    number: int  # in the model; and of its site
    site: int
    body: int  # that has the site
    # What would put the site at the clamp, and turn its axes to the sweep's nearest: its place and
    # quaternion on its body, shapes (3,) and (4,); and the direction of the vibrissa there.
    clamp: Floats
    quaternion: Floats
    along: Floats
    # Shape (3, 3); Its reading of a unit of the clamp's action on the vibrissa along x, y, z of the
    # sweep, in columns: a rotation, if it reads what it should.
    axes: Floats
    # Shape (3,); Where its site is, from the clamp, in the axes of the sweep [length].
    place: Floats
    # Shape (3,); From where its moments are counted, by its own readings; the same [length].
    lever: Floats
    # False where MuJoCo leaves them out: of a flex, by a sensor on what its vertices hang on.
    feels_contacts: bool
    cutoff: float  # the largest reading that it gives; infinite if it has no such limit
    free: bool  # whether it is on a free body: MuJoCo leaves what a weld does to that out
    bends: bool  # whether it is on a link, and turns with it as the vibrissa bends
    carries: float  # the mass on it, without the vibrissa
    late: float = 0.0  # by its own delay, and the time from one reading to the next


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint, as the springs of one body."""

    name: str  # the body's, or as ``"body 3"``
    numbers: tuple[int, ...]  # of the body's joints in the model
    rigid: tuple[str, ...]  # bodies without a joint between this one and the next
    s: float  # its arc length from the clamp [length]
    # Length of the piece of beam that it stands for: half way to its neighbours [length].
    cell: float
    compliance: float  # turn over moment
    angle: float  # its turn at rest [rad]
    springref: float  # the largest turn at which a spring of its hinges rests [rad]
    damping: float  # of its dampers, the largest [force length time]
    mass: float  # of the body

    @property
    def flexural_rigidity(self) -> float:
        """Of that piece of beam: cell over compliance [force length^2]."""
        return self.cell / self.compliance


@dataclass(frozen=True, eq=False)
class Geom:
    """A geom of the vibrissa."""

    name: str  # its own, its body's, or as ``"geom 3"``
    number: int  # in the model; of a flex's edge, the flex
    start: float  # arc lengths of its axis [length]
    end: float  # arc lengths of its axis [length]
    aside: float  # how far an end of its axis is from the vibrissa's [length]
    aside_in_plane: float  # and without what of that is across the plane of the sweep
    radius: float  # [length]
    size: tuple[float, ...]  # MuJoCo's of a sphere, capsule or cylinder; of others empty
    rounded: bool  # whether its ends are round, and reach beyond its axis: a capsule
    # Whether it collides with an object that has MuJoCo's default contype and conaffinity.
    meets: bool
    kept_apart: bool  # from the world, where objects are, by <exclude>
    weight: float  # the acceleration by a unit of force that MuJoCo takes; 0 if it cannot move
    stiffness: float  # force over penetration of its contacts at rest, about [force/length]
    # Of its contacts, as its solref says; NaN if solref states a stiffness [time].
    time_constant: float
    decay: float  # of how fast it meets an object, by its contact's damper [1/time]
    damping_ratio: float  # of its contacts
    friction: float  # coefficient; 0 if its contacts have no friction
    margin: float  # how far from an object its contacts push; negative: how deep [length]

    @property
    def middle(self) -> float:
        """Arc length of the middle of its axis [length]."""
        return (self.start + self.end) / 2


@dataclass(frozen=True, eq=False, repr=False)
class MeasuredBeam(Shown):
    """The beam that a user's model is, its foot held.

    Attributes
    ----------
    model, foot : str
        Name of the model and of the body that holds the vibrissa.
    body : int
        Number of that body; 0 is the world.
    body_mass : float
        Of that body alone.
    leads : int
        Number of the body on it that is the first link, or holds that.
    frame : array, shape (4, 3)
        Where the vibrissa begins on that body, and the axes of the sweep, in rows.
    springs : str
        What bends it: ``"joints"``, ``"plugin"`` or ``"flex"``.
    drive : str or None
        What can move the foot; None if nothing can.
    rail : Rail or None
        The slide that moves the foot, or the nearest to that; None if it has no slide.
    reach : Reach or None
        What limits a slide that moves the foot; None of another drive.
    switched : tuple of (str, str)
        Attributes of `<flag>` by which contacts or drives do not act as they are stated, and what
        they would have to be.
    objects : tuple of str
        Other bodies that touch and can be moved.
    hand : Hand or None
        What gives way between drive and vibrissa; None if nothing can.
    length : float
        From the clamp to the centre of the round tip [length].
    joints : tuple of Joint
        From the clamp to the tip.
    geoms : tuple of Geom
        Likewise.
    tip_rigidity : float
        EI of the uniform beam with the same small tip deflection under a force on the tip.
    stretch : float
        Strain of the edge that gives way most over a pull; 0 for links [1/force].
    loads : array, shape (n,)
        Forces on the tip across the beam [force].
    bent : array, shape (n, 2)
        How far the tip moves along them, and along the beam towards the clamp [length].
    out_of_plane : float
        Largest distance of joints and tip from the plane in which it bends [length].
    mass : float
    period, period_without_armature : float
        The first of free vibration along the sweep [time].
    stable_step : float
        The longest stable time step of an integrator that is explicit in springs [time].
    unsolved : float
        By how much the sensors read otherwise, past an object, with MuJoCo's solver as it is than
        with one that goes on to the end, relative to the largest.
    unloaded : tuple of float
        By how much drive and hand make the rms of force and moment in the plane larger, past
        nothing.
    damping_ratio : float
        Of the first vibration.
    medium : tuple of float
        Density, viscosity and the strength of the wind of what it moves in.
    gravity : tuple of float
        In the axes of the sweep.
    sag : float
        How far gravity moves the tip [length].
    weight : float
        What the force sensor reads of gravity in the plane, with nothing touching [force].
    force, torque : Sensed or None
        The sensors at the clamp.
    planar : bool
        Whether its joints keep it in the plane of the sweep.
    lean : float
        From across the vibrissa, of the axes of hinges that are all alike [rad].
    torsion : float
        Its torsional over its flexural rigidity, as the tip feels both; infinite if it cannot
        twist.
    self_contacts : tuple of str
        Pairs of geoms, one of them the vibrissa's, that touch in the first state.
    in_the_way : tuple of int
        Geoms that move with the foot and touch the vibrissa once that or they are bent.
    on_its_way : tuple of str
        Geoms that do not move with the foot and that it meets as the foot goes.
    ahead : tuple of int
        Geoms on the foot, or on what the sensors feel, that an object meets beside it.
    timestep : float
    integrator : str
    cone : str
        Of friction.
    friction_loss : float
        The largest moment by which friction holds a joint as fast as it turns in a sweep.
    limits, stiffening : tuple of float
        How far limits of its joints, and springs that are not linear, move the tip where it is bent
        as by the sweep, and bent the other way [length].
    """

    model: str
    foot: str
    body: int
    body_mass: float
    leads: int
    frame: Floats
    springs: Literal["joints", "plugin", "flex"]
    drive: str | None
    rail: Rail | None
    reach: Reach | None
    switched: tuple[tuple[str, str], ...]
    objects: tuple[str, ...]
    hand: Hand | None
    length: float
    joints: tuple[Joint, ...]
    geoms: tuple[Geom, ...]
    tip_rigidity: float
    stretch: float
    loads: Floats
    bent: Floats
    out_of_plane: float
    mass: float
    period: float
    period_without_armature: float
    stable_step: float
    unsolved: float
    unloaded: tuple[float, float]
    damping_ratio: float
    medium: tuple[float, float, float]
    gravity: tuple[float, float, float]
    sag: float
    weight: float
    force: Sensed | None
    torque: Sensed | None
    planar: bool
    lean: float
    torsion: float
    self_contacts: tuple[str, ...]
    in_the_way: tuple[int, ...]
    on_its_way: tuple[str, ...]
    ahead: tuple[int, ...]
    timestep: float
    integrator: IntegratorKind
    cone: ConeKind
    friction_loss: float
    limits: tuple[float, float]
    stiffening: tuple[float, float]

    @property
    def natural_curvature(self) -> float:
        """Mean over the length, of its turns at rest [1/length]."""
        return sum(joint.angle for joint in self.joints) / self.length

    def _tiles(self) -> dict[str, object]:
        return {
            "model": self.model,
            "foot": self.foot,
            "length": f"{self.length:.4g}",
            "EI at the tip": f"{self.tip_rigidity:.4g}",
            self.springs: len(self.joints),
            "period": f"{self.period:.3g}",
            "damping ratio": f"{self.damping_ratio:.3g}",
            "sag": f"{self.sag:.3g}",
        }

    def _draw(self, figure: "Figure") -> None:
        ax, places = figure.subplots(), [joint.s for joint in self.joints]
        ax.plot(places, [joint.flexural_rigidity for joint in self.joints], "o-", label="EI")
        ax.axhline(self.tip_rigidity, color="grey", linestyle="--", label="as the tip feels it")
        ax.set(xlabel="arc length from the clamp", ylabel="flexural rigidity")
        ax.legend()

    def to_dict(self) -> dict[str, Any]:
        """All of it.

        Returns
        -------
        dict
            JSON can hold it.
        """
        found = asdict(self) | {"natural_curvature": self.natural_curvature}
        return {name: _plain(value) for name, value in found.items()}


def nearest_axes(turned: Floats) -> Floats:
    """The turn by right angles that is nearest to what a sensor reads, shape (3, 3)."""
    nearest = np.zeros((3, 3))
    for row, column in enumerate(np.argmax(np.abs(turned), axis=1)):
        nearest[row, column] = np.sign(turned[row, column])
    return nearest


def _plain(value: Any) -> Any:  # noqa: ANN401  # whatever the fields hold
    if isinstance(value, dict):
        return {key: _plain(inner) for key, inner in value.items()}
    if isinstance(value, tuple | list):
        return [_plain(inner) for inner in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value
