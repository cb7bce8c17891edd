"""From a case and settings to an obstacle."""

from analytic.problem.case import Case
from analytic.problem.contours.contour import ConvexMesh
from analytic.problem.errors import InputError
from mujoco_models.obstacles.primitive import Primitive
from mujoco_models.obstacles.prism import Prism
from mujoco_models.obstacles.protocol import Obstacle
from mujoco_models.settings import Settings


def place(case: Case, settings: Settings) -> Obstacle:
    obstacle = _made(case, settings)
    if len(obstacle.corners) and case.beam.tip_radius not in (None, case.beam.radius):
        raise InputError(
            "beam.tip_radius",
            case.beam.tip_radius,
            f"{case.beam.radius:g}, the radius, where the object has sharp corners",
            "leave it out, or round the object: corners are touched by the sides of straight links",
        )
    return obstacle


def _made(case: Case, settings: Settings) -> Obstacle:
    if settings.obstacle == "primitive":
        return Primitive.of(case)
    solid = case.profile.scaled(1 / case.beam.length).solid
    if isinstance(solid, ConvexMesh):
        from mujoco_models.obstacles.file_mesh import FileMesh  # what finds hulls is slow to load

        return FileMesh(case, solid, settings.corner_radius)
    return Prism.of(case, settings.contour_points, settings.corner_radius)
