"""MuJoCo as one of the engines, and the default."""

from collections.abc import Callable

from analytic.problem.case import Case
from analytic.problem.readings import Readings
from engines.engine import Role
from mujoco_models.settings import Settings
from mujoco_models.simulate import simulate_sweep


class _Mujoco:
    """See `engines.engine.Engine`."""

    name = "mujoco"
    role: Role = "subject"
    requires = "mujoco>=3.17,<5"
    tuned = "the settings of [mujoco], which are ours: a rest solver on its balance of forces"

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> Readings:
        return simulate_sweep(case, settings, advance)


ENGINE = _Mujoco()
