"""Pinocchio's chain as an engine: a twin of MuJoCo's."""

from collections.abc import Callable
from importlib.metadata import version

from analytic.problem.case import Case
from analytic.problem.readings import Readings
from engines.engine import Role
from engines.linkage import Maker
from engines.twin import sweep_twin
from mujoco_models.settings import Settings


class _Pinocchio:
    """See `engines.engine.Engine`."""

    name = "pinocchio"
    role: Role = "twin"
    requires = "pin>=4.1,<5"
    tuned = (
        "coal's tolerance, from 1e-6 to 1e-12; joints, springs, spheres, contact stiffness and "
        "rest solver are those of MuJoCo's chain"
    )

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> Readings:
        """By the rest solver of MuJoCo's chain, on Pinocchio's balance of moments."""

        def maker() -> Maker:
            from engines.pinocchio.chain import PinocchioLinkage  # imports Pinocchio

            return PinocchioLinkage

        engine = f"Pinocchio {version('pin')}, coal {version('coal')}"
        return sweep_twin(case, settings, "pinocchio", engine, maker, advance)


ENGINE = _Pinocchio()
