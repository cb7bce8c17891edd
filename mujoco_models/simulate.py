"""What others ask of MuJoCo: a sweep, a load on the tip, a look.

MuJoCo itself is imported when one of them is called, not before.
"""

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, overload

from analytic.problem.beam import Beam
from analytic.problem.case import Case
from analytic.problem.errors import require
from analytic.problem.readings import Readings
from analytic.problem.recorder import facing, keep_facing, leftward
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings

if TYPE_CHECKING:
    from analytic.space.problem.case import SpatialCase
    from analytic.space.problem.readings import SpatialReadings
    from mujoco_models.inspect.measured import MeasuredBeam
    from mujoco_models.settings import SpatialSettings
    from mujoco_models.user_model.names import OwnModel


def simulate_sweep(
    case: Case,
    settings: Settings | None = None,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
) -> Readings:
    """Sweep `case` in MuJoCo.

    Parameters
    ----------
    case : Case
        The problem; all that the simulation knows of it.
    settings : Settings, optional
        The numerics.
    advance : callable, optional
        Called after every station, for progress bars.
    keep : callable, optional
        Given the readings of all stations so far (if two or more) when the sweep ends early,
        whatever ends it: a divergence, whose station is the last row then, an interrupt, an
        exception in `advance`. The exception then goes on its way.

    Returns
    -------
    Readings
        In the units of the case's beam, source ``"mujoco <beam>"``, with four columns more:
        ``residual``, the largest moment out of balance at any joint; ``discrepancy``, by how
        much (dimensionless) the clamp's sensors differ from the sum of the contacts' forces and
        moments or from the beam's own moment at its first joint, whichever is worse;
        ``penetration``, how deep the loaded beads are in the obstacle on average [length]; and
        ``extension``, by how much the beam is too long, over its length.
        ``provenance["events"]["snap_off"]`` is where the simulation let go, and
        ``provenance["unsettled"]`` counts the stations that are unsettled, by reason. A vibrissa
        that is curved at rest may come to touch in two places: the columns ``second_contact_x`` and
        its like are then of the outer one, as far as links can show two. Where it touches in more,
        ``status`` is ``"touches again"``, and the clamp's readings are those of all contacts.

        If the settings let the beam leave the plane of the sweep, there are also the columns
        ``out_of_plane``, the largest distance of any of its points from the plane, and
        ``sideways_stiffness``, force across the plane over displacement at the contact
        [force/length], NaN where nothing touches; the residual is then that of all directions, and
        ``provenance["events"]["out_of_plane"]`` is where the beam left the plane.

    Raises
    ------
    InputError
        If the case's beam has no radius: MuJoCo cannot collide a line. If the object rubs: with
        friction many states are at rest, see `simulate_motion`. If the beam may leave the plane and
        is curved at rest, or its clamp turns. If the installed MuJoCo lacks the beam that the
        settings ask for, or has no such obstacle for the contour.
    DivergedError
        If the simulation is not a number any more; it names the station.
    MemoryError
        If there are more segments or contacts than MuJoCo or the machine has room for.
    ClampError
        If that discrepancy is more than the station's residual can explain.
    """
    from mujoco_models.sweep.sweep import run_sweep

    chosen = Settings() if settings is None else settings
    require("settings", chosen, Settings, "as Settings(beam='chain', segments=40)")

    found = run_sweep(leftward(case), chosen, advance, keep_facing(case, keep))
    return facing(case, found)


def simulate_space(
    case: "SpatialCase",
    settings: "SpatialSettings | None" = None,
    advance: Callable[[], None] = lambda: None,
    keep: "Callable[[SpatialReadings], None]" = lambda _: None,
) -> "SpatialReadings":
    """Sweep a case in space in MuJoCo, at rest at every station.

    Parameters
    ----------
    case : SpatialCase
        The problem; all that the simulation knows of it.
    settings : SpatialSettings, optional
        The numerics.
    advance, keep : callable, optional
        As of `simulate_sweep`.

    Returns
    -------
    SpatialReadings
        In the units of the case's beam, source ``"mujoco <beam>"``, only of stable equilibria.
        More columns: ``stability``, the least eigenvalue of the stiffness of vibrissa and contact
        over that of the joints' springs; ``residual``, the largest moment out of balance at a joint
        by MuJoCo's own forces [force length]; ``discrepancy``, by how much (dimensionless) the
        clamp's sensors differ from the contacts' sum; ``penetration`` [length]. ``status`` is
        ``"unsettled"`` where the vibrissa does not come to rest, and ``"slipped off"``, without
        readings, from where no stable equilibrium is close by any more to where the straight
        vibrissa would be clear of the body. ``provenance["events"]`` lists what happens where, as
        `analytic.space.solve_space` does.

    Raises
    ------
    InputError
        If the case's beam has no radius, the installed MuJoCo lacks the beam, or the body has too
        many vertices.
    DivergedError
        If the simulation is not a number any more; it names the station.
    """
    from analytic.space.problem.case import SpatialCase
    from mujoco_models.settings import SpatialSettings
    from mujoco_models.space.sweep import run_space

    chosen = SpatialSettings() if settings is None else settings
    require("case", case, SpatialCase, "as SpatialCase(body=..., path=...)")
    require("settings", chosen, SpatialSettings, "as SpatialSettings(segments=40)")
    return run_space(case, chosen, advance, keep)


@overload
def simulate_motion(
    case: Case,
    motion: Motion | None = None,
    settings: Settings | None = None,
    advance: Callable[[], None] = ...,
    keep: Callable[[Readings], None] = ...,
) -> Readings: ...
@overload
def simulate_motion(
    case: "SpatialCase",
    motion: Motion | None = None,
    settings: "SpatialSettings | None" = None,
    advance: Callable[[], None] = ...,
    keep: "Callable[[SpatialReadings], None]" = ...,
) -> "SpatialReadings": ...
def simulate_motion(
    case: "Case | SpatialCase",
    motion: Motion | None = None,
    settings: "Settings | SpatialSettings | None" = None,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[..., None] = lambda _: None,
) -> "Readings | SpatialReadings":
    """Sweep `case` in MuJoCo at a steady speed, the beam with its mass, stepped by `mj_step`.

    Parameters
    ----------
    case : Case or SpatialCase
        The problem; all that the simulation knows of it. In space the foot's way is straight, the
        vibrissa a chain on balls, the body a sphere, an ellipsoid or a cylinder.
    motion : Motion, optional
        Speed, time step, integrator, damping and contact.
    settings : Settings or SpatialSettings, optional
        Beam, segments and obstacle; contact stiffness and tolerance are those of a sweep at rest.
    advance, keep : callable, optional
        As of `simulate_sweep`.

    Returns
    -------
    Readings or SpatialReadings
        In the units of the case's beam, source ``"mujoco <beam> in motion"``. The clamp's readings
        are means over the way round each station, see `Motion`; ``force_x_raw``, ``force_y_raw``
        and ``moment_z_raw`` are those of the moment. More columns: ``time`` [T1],
        ``kinetic_share``, the kinetic energy seen from the foot over kinetic and elastic energy;
        ``contact_losses``, how often the contact was lost since the station before, and
        ``penetration`` [length]. A station is ``"chattering"`` if the contact was lost more than
        once or for 5 % of its way, ``"creeping"`` if it moves along the object with less friction
        than its coefficient says, and ``"lost"`` if nothing touches there but does later.
        ``second_contact_*`` are as of `simulate_sweep`, past several objects, too.
        ``provenance["events"]["snap_off"]`` is where the last contact was lost; in space the events
        are a list, and ``friction_*`` is MuJoCo's friction over its normal force.

    Raises
    ------
    InputError
        If the case's beam has no radius; if friction would overshoot in the time step; if the
        installed MuJoCo lacks the beam, or it is no chain or rod in the plane; in space if friction
        has a pyramid for its cone, the way a corner, or the body is another.
    DivergedError
        If the motion does not stay finite; it names the time and what to change.
    """
    from mujoco_models.dynamics.sweep import run_motion

    moved = require("motion", motion or Motion(), Motion, "as Motion(speed=0.01)")
    if not isinstance(case, Case):
        from analytic.space.problem.case import SpatialCase
        from mujoco_models.settings import SpatialSettings
        from mujoco_models.space.motion import run_space_motion

        require("case", case, SpatialCase, "as SpatialCase(body=..., path=...), or a Case")
        in_space = settings or SpatialSettings()
        in_space = require("settings", in_space, SpatialSettings, "as SpatialSettings(segments=40)")
        return run_space_motion(case, moved, in_space, advance, keep)
    chosen = require("settings", settings or Settings(), Settings, "as Settings(segments=40)")
    found = run_motion(leftward(case), moved, chosen, advance, keep_facing(case, keep))
    return facing(case, found)


def simulate_there_and_back(
    case: Case,
    motion: Motion | None = None,
    settings: Settings | None = None,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
) -> tuple[Readings, Readings]:
    """Sweep `case` in motion, turn round beyond the last station, and come back past all of them.

    Speed and direction change evenly over twice `Motion.ramp`. With friction the contact sticks
    while the foot turns, and then slides back: see `analytic.turn_back`. Past the snap-off the
    vibrissa comes back to the object from its other side.

    Parameters
    ----------
    case, motion, settings, advance, keep
        As of `simulate_motion`; `keep` may be called for either way.

    Returns
    -------
    on, back : Readings
        As of `simulate_motion`; the stations of the way back in the order in which they are passed.
        Its ``provenance["events"]`` say where the foot turned (``"turn"``) and where the last
        contact ended: by ``"release"``, or by ``"snap_off"`` if the way on has ended so, too.

    Raises
    ------
    InputError, DivergedError
        As `simulate_motion` does.
    """
    from mujoco_models.dynamics.sweep import run_there_and_back

    moved = require("motion", motion or Motion(), Motion, "as Motion(speed=0.01)")
    chosen = require("settings", settings or Settings(), Settings, "as Settings(segments=40)")
    on, back = run_there_and_back(leftward(case), moved, chosen, advance, keep_facing(case, keep))
    return facing(case, on), facing(case, back)


def load_tip(
    load: float,
    settings: Settings | None = None,
    beam: Beam | None = None,
    clamp_stiffness: float = math.inf,
) -> tuple[float, float]:
    """Tip of a cantilever under a dead load to the right, across the clamp's tangent.

    Parameters
    ----------
    load : float
        P L^2/EI.
    settings : Settings, optional
        Beam, number of segments, clamp and tolerance; nothing else matters without a contact.
    beam : Beam, optional
        The vibrissa; a straight and uniform one if it is not given.
    clamp_stiffness : float
        Moment of the clamp by its rotation [force length/rad]; infinite if rigid.

    Returns
    -------
    across, shortening : float
        Displacement of the tip along the load and along the clamp's tangent, towards the clamp [L].

    Raises
    ------
    InputError
        If the installed MuJoCo lacks the beam.
    RuntimeError
        If the beam does not come to rest.
    """
    from mujoco_models.sweep import cantilever

    return cantilever.load_tip(load, settings or Settings(), beam or Beam(), clamp_stiffness)


def inspect_model(
    path: str | Path,
    *,
    foot: str | None = None,
    force: str | None = None,
    torque: str | None = None,
    geoms: str | None = None,
    site: str | None = None,
) -> "MeasuredBeam":
    """Measure what beam a user's own model is; its files are only read.

    Parameters
    ----------
    path : str or Path
        An MJCF or URDF file, or the name of a shipped model.
    foot : str, optional
        The body that holds the vibrissa. What is not named is looked for.
    force, torque : str, optional
        The sensors at its clamp.
    geoms : str, optional
        The vibrissa's geoms: names or patterns as ``"whisker*"``, separated by commas.
    site : str, optional
        At the clamp; a force and a torque sensor are added there, in memory.

    Returns
    -------
    MeasuredBeam
        In the model's own units.

    Raises
    ------
    InputError
        If the model, a name of it or the vibrissa cannot be used.
    """
    from mujoco_models.inspect import measure, parts
    from mujoco_models.user_model.shipped import find_model

    return measure.inspect_model(find_model(path), parts.Names(foot, force, torque, geoms, site))


def simulate_model(
    case: Case,
    model: "OwnModel",
    motion: Motion | None = None,
    settings: Settings | None = None,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
) -> Readings:
    """Sweep a user's own model past the object of `case`, with its own time step and solver.

    The object is put into the model's world, in memory, so that the sweep begins where the foot is.
    The foot is moved by what the model has for that, and the clamp is read by the model's sensors,
    turned into the frame of the sweep.

    Parameters
    ----------
    case : Case
        The problem, with the vibrissa that the model should be, in the model's units.
    model : OwnModel
        The model's file, and names.
    motion : Motion, optional
        Speed, soft start, average and filter; the contact's stiffness if it is to be ours. All else
        is the model's.
    settings : Settings, optional
        Points of the object's contour.
    advance, keep : callable, optional
        As of `simulate_sweep`.

    Returns
    -------
    Readings
        As of `simulate_motion`, source ``"model <name>"``; ``provenance["measured"]`` says what
        beam the model is. T1 is the model's own first period. A station is ``"touches another"`` if
        the vibrissa touches more than the object, or the object more than the vibrissa.

    Raises
    ------
    InputError
        If the model or a name cannot be used, its length is not the case's, nothing moves its foot
        along the sweep, it has no sensors, or its geoms touch nothing or each other.
    DivergedError
        If the motion does not stay finite.
    """
    from mujoco_models.user_model.sweep import run_user_model

    moved, chosen = motion or Motion(), settings or Settings()

    found = run_user_model(leftward(case), model, moved, chosen, advance, keep_facing(case, keep))
    return facing(case, found)


def view_sweep(case: Case, settings: Settings | None = None) -> None:
    """Show the sweep of `case` in MuJoCo's interactive viewer, until its window is closed.

    Parameters
    ----------
    case : Case
        The problem.
    settings : Settings, optional
        The numerics.

    Raises
    ------
    InputError
        If there is no display, or the case's beam has no radius.
    """
    from mujoco_models.view import show

    show(case, settings or Settings())
