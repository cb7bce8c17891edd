"""DART's chain as an engine: the same rod in hard contact, stepped until it rests."""

from collections.abc import Callable
from dataclasses import asdict
from importlib.metadata import version

from threadpoolctl import threadpool_limits

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from engines.engine import Role
from engines.stepping import Stepper, sweep_stepping
from mujoco_models.settings import Settings


class _Dart:
    """See `engines.engine.Engine`."""

    name = "dart"
    role: Role = "other model"
    requires = "dartpy>=6.20,<7"
    tuned = (
        "no sleep and no friction; springs as torques of every step; inertia and damping for a "
        "quick rest, which shows in no reading"
    )

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> Readings:
        case.require_plain("dart")
        if case.radius == 0:
            raise InputError("beam.radius", 0, "positive for dart", "it cannot collide a line")
        about = {
            "engine": f"DART {version('dartpy')}, vibrissa-testbed {version('vibrissa-testbed')}",
            "settings": asdict(settings),
        }

        def stepper(leftward: Case) -> Stepper:
            from engines.dart.chain import DartChain  # imports DART

            return DartChain(leftward, settings)

        with threadpool_limits(1):
            return sweep_stepping(case, stepper, "dart chain", about, advance)


ENGINE = _Dart()
