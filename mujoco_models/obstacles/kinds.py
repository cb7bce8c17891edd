"""From a case and settings to an obstacle."""

from analytic.problem.case import Case
from analytic.problem.contours.solid import ConvexMesh
from mujoco_models.obstacles.file_mesh import FileMesh
from mujoco_models.obstacles.primitive import Primitive
from mujoco_models.obstacles.prism import Prism
from mujoco_models.obstacles.protocol import Obstacle
from mujoco_models.settings import Settings


def place(case: Case, settings: Settings) -> Obstacle:
    """The obstacle that the settings ask for.

    Parameters
    ----------
    case : Case
        Of a sweep to the left.
    settings : Settings
        Which obstacle, and how fine.

    Returns
    -------
    Obstacle
        Dimensionless, L = 1.

    Raises
    ------
    InputError
        If MuJoCo has no such obstacle for the case's contour.
    """
    if settings.obstacle == "primitive":
        return Primitive.of(case)
    solid = case.profile.scaled(1 / case.beam.length).solid
    if isinstance(solid, ConvexMesh):
        return FileMesh(case, solid, settings.corner_radius)
    return Prism.of(case, settings.contour_points, settings.corner_radius)
