"""The model before it is compiled: the beam with its beads, the clamp's sensors, the obstacle."""

from collections.abc import Mapping

import mujoco
import numpy as np

from analytic.problem.errors import InputError
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.links import mass_by_length
from mujoco_models.beams.protocol import FOOT, Beam
from mujoco_models.model.surface import CONTACT_GAP, SIDE_PREFIX
from mujoco_models.obstacles.corners import LINKS, Corners
from mujoco_models.obstacles.protocol import Obstacle

CCD_TOLERANCE = 1e-12  # L, of MuJoCo's searches for the nearest points
# Bytes. A vibrissa bent round an object may have 6,000 beads within its gap, and MuJoCo's own
# choice has no room to solve for them; what is not used takes none.
_MEMORY = 2**28


def assemble(beam: Beam, radius: float, obstacles: Mapping[str, Obstacle]) -> mujoco.MjSpec:
    """Beam, beads, sensors and obstacles, by the names of their geoms.

    The beam touches facets with spheres on its axis, not with capsules: the distance of a point to
    a convex body has a continuous derivative, so an equilibrium exists at every station; a capsule
    that lies along a facet has no single nearest point, its contact jumps from end to end, and
    nothing comes to rest. Sharp corners are what the capsules of the links touch.
    """
    layout = beam.layout
    radii = radius * layout.vibrissa.thickness(layout.beads)

    def furnish(body: mujoco.MjsBody, link: int) -> None:
        own = layout.links == link
        places = beam.within(link, layout.beads[own])
        for place, size in zip(places, radii[own], strict=True):
            bead = body.add_geom()  # what it is, as arguments, takes twice the time
            bead.type, bead.pos, bead.size[0] = mujoco.mjtGeom.mjGEOM_SPHERE, place, size
            bead.contype, bead.conaffinity, bead.condim = 0, 1, 1
            bead.density, bead.gap, bead.priority = 0, CONTACT_GAP, 1

    spec = beam.spec(radius, furnish)
    add_options(spec)
    if any(layout.vibrissa.weight):
        set_weight(spec, layout, mass_by_length(layout))
    for name, obstacle in obstacles.items():
        obstacle.add_to(spec, name)
    corners = Corners.of_all([obstacle.corners for obstacle in obstacles.values()])
    if len(corners):
        corners.add_to(spec)
        _let_links_collide(beam, spec)
    add_clamp_sensors(spec)
    return spec


def add_clamp_sensors(spec: mujoco.MjSpec) -> None:
    """Add a force and a torque sensor at the foot."""
    spec.body(FOOT).add_site(name="clamp")
    for kind in (mujoco.mjtSensor.mjSENS_FORCE, mujoco.mjtSensor.mjSENS_TORQUE):
        spec.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="clamp")


def _let_links_collide(beam: Beam, spec: mujoco.MjSpec) -> None:
    """With the edges of the obstacle's corners."""
    for link in range(len(beam.layout.joints)):
        geoms = beam.body(spec, link).geoms
        (capsule,) = (g for g in geoms if g.type == mujoco.mjtGeom.mjGEOM_CAPSULE)
        capsule.name, capsule.conaffinity = f"{SIDE_PREFIX}{link}", LINKS
        capsule.condim, capsule.priority, capsule.gap = 1, 1, CONTACT_GAP


def add_options(spec: mujoco.MjSpec) -> None:
    """Set what every model needs for its forces to be right to rounding."""
    spec.memory = _MEMORY
    option = spec.option
    option.gravity = [0, 0, 0]
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE  # 4.0.0: wrong Hessian with sparse ones
    option.tolerance = 1e-14
    option.ccd_tolerance = CCD_TOLERANCE
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_MULTICCD
    # The midphase's tree tests every bead against every window: seven times the cost of a step.
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_MIDPHASE


def set_weight(spec: mujoco.MjSpec, layout: Layout, mass_by_length: float) -> None:
    """Let links of a mass by length weigh what the vibrissa does."""
    spec.option.gravity = [*(np.array(layout.vibrissa.weight) / mass_by_length), 0]


def compiled(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """What MuJoCo makes of it."""
    try:
        return spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        raise InputError(
            "MuJoCo's model",
            f"impossible ({' '.join(str(error).split())[:150]})",
            "of a vibrissa and an object that are neither too thin nor too small for MuJoCo",
            "give a larger radius or object, or state all in smaller units, as mm without units",
        ) from error
