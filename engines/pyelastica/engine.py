"""PyElastica's rod as an engine: another rod of its own, at rest on its own forces."""

from collections.abc import Callable
from importlib.metadata import version

from threadpoolctl import threadpool_limits

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from engines.engine import Role
from engines.stepping import Stepper, sweep_stepping
from mujoco_models.settings import Settings

_LET_GO = 1e-6  # L; a rest takes milliseconds, so a snap-off is located finely


class _PyElastica:
    """See `engines.engine.Engine`."""

    name = "pyelastica"
    role: Role = "other model"
    requires = "pyelastica>=1.0,<2"
    tuned = (
        "the rod begins half an element before the clamp; a contact of our own, 1e9 EI/L^4; shear "
        "and stretch 1e5 EI/L^2; rest by Newton's method, instead of steps in time"
    )

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> Readings:
        """Rest after rest, past the contour itself: no mesh."""
        case.require_plain("pyelastica")
        if case.radius == 0:
            raise InputError("beam.radius", 0, "positive for pyelastica", "it cannot touch a line")
        chosen = {"elements": settings.segments, "obstacle": "the contour, by a contact of our own"}
        about = {
            "engine": f"PyElastica {version('pyelastica')}, "
            f"vibrissa-testbed {version('vibrissa-testbed')}",
            "settings": chosen,
        }

        def stepper(leftward: Case) -> Stepper:
            from engines.pyelastica.rod import ElasticaRod  # imports PyElastica

            return ElasticaRod(leftward, settings.segments)

        with threadpool_limits(1):
            return sweep_stepping(case, stepper, "pyelastica rod", about, advance, _LET_GO)


ENGINE = _PyElastica()
