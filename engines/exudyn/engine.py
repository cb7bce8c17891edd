"""Exudyn's cable as an engine: another discretisation of the same vibrissa."""

from collections.abc import Callable
from importlib.metadata import version

from threadpoolctl import threadpool_limits

from analytic.problem.case import Case
from analytic.problem.contours.polygon import Polygon
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from engines.engine import Role
from engines.stations import Rest, sweep_stations
from mujoco_models.settings import Settings

PENALTY = 1e6
"""The stiffest contact of a piece [EI/L^3]: a load of 10 EI/L^2 is 1e-5 L deep. With ten times that
Exudyn's static solver loses its convergence on the catenary at 20 elements."""


class _Exudyn:
    """See `engines.engine.Engine`."""

    name = "exudyn"
    role: Role = "other model"
    requires = "exudyn>=1.13,<2"
    tuned = (
        "contact penalty 1e6 EI/L^3, or that of [mujoco] if it is softer; axial stiffness 1e6 "
        "EI/L^2; eight pieces of an element touch; found by trying, on the catenary and a circle"
    )

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> Readings:
        """By its static solver, station after station, past the contour itself: no mesh."""
        case.require_plain("exudyn")
        if isinstance(case.profile, Polygon):
            raise InputError(
                "object for exudyn",
                f"with corners ({case.profile.label})",
                "smooth: between two corners the contact has no one circle to be fixed at",
                "leave exudyn out, or draw a smooth curve through the corners",
            )
        penalty = min(PENALTY, settings.contact_stiffness)
        chosen = {
            "elements": settings.segments,
            "penalty": penalty,
            "obstacle": "the contour's circle of curvature, where the contact is",
        }
        about = {
            "engine": f"Exudyn {version('exudyn')}, vibrissa-testbed {version('vibrissa-testbed')}",
            "settings": chosen,
        }

        def rest(leftward: Case) -> Rest:
            from engines.exudyn.contact import Contact  # Exudyn is imported only where it is used

            return Contact(leftward, settings.segments, penalty)

        with threadpool_limits(1):
            return sweep_stations(case, rest, "exudyn ANCF cable", about, advance)


ENGINE = _Exudyn()
