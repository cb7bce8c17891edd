"""From a case and settings to an obstacle."""

from analytic.problem.case import Case
from mujoco_models.obstacles.primitive import Primitive
from mujoco_models.obstacles.prism import Prism
from mujoco_models.obstacles.protocol import Obstacle
from mujoco_models.settings import Settings


def place(case: Case, settings: Settings) -> Obstacle:
    """The obstacle that the settings ask for.

    Raises
    ------
    InputError
        If MuJoCo has no such obstacle for the case's contour.
    """
    if settings.obstacle == "primitive":
        return Primitive.of(case)
    return Prism.of(case, settings.contour_points)
