"""PyElastica's rod as an engine: another rod of its own, stepped until it rests."""

from collections.abc import Callable
from importlib.metadata import version

from threadpoolctl import threadpool_limits

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from engines.engine import Role
from engines.stepping import Stepper, sweep_stepping
from mujoco_models.settings import Settings

_LET_GO = 0.2  # L; its snap-off is located as well as one of so many elements is right


class _PyElastica:
    """See `engines.engine.Engine`."""

    name = "pyelastica"
    role: Role = "other model"
    requires = "pyelastica>=1.0,<2"
    tuned = (
        "the rod begins half an element before the clamp; a contact of our own; stiffness of shear "
        "and stretch 4e4 EI/L^2; masses and damping for a quick rest, which shows in no reading"
    )

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> Readings:
        """By steps in time, past the contour itself: no mesh."""
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
            return sweep_stepping(
                case, stepper, "pyelastica rod", about, advance, _LET_GO / settings.segments**2
            )


ENGINE = _PyElastica()
