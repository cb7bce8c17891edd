"""Drake's chain as an engine: a twin of MuJoCo's."""

from collections.abc import Callable
from importlib.metadata import version

from analytic.problem.case import Case
from analytic.problem.readings import Readings
from engines.engine import Role
from engines.linkage import Maker
from engines.twin import sweep_twin
from mujoco_models.settings import Settings


class _Drake:
    """See `engines.engine.Engine`."""

    name = "drake"
    role: Role = "twin"
    requires = "drake>=1.40,<2"
    tuned = (
        "nothing: joints, springs, spheres, contact stiffness and rest solver are those of "
        "MuJoCo's chain"
    )

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> Readings:
        """By the rest solver of MuJoCo's chain, on Drake's balance of moments."""

        def maker() -> Maker:
            from engines.drake.chain import DrakeLinkage  # imports Drake

            return DrakeLinkage

        return sweep_twin(case, settings, "drake", f"Drake {version('drake')}", maker, advance)


ENGINE = _Drake()
