"""Exudyn's cable as an engine: another discretisation of the same vibrissa."""

from collections.abc import Callable
from importlib.metadata import version

from threadpoolctl import threadpool_limits

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from engines.engine import Role
from engines.stations import Rest, sweep_stations
from mujoco_models.settings import Settings


class _Exudyn:
    """See `engines.engine.Engine`."""

    name = "exudyn"
    role: Role = "other model"
    requires = "exudyn>=1.13,<2"
    tuned = (
        "axial stiffness 1e6 EI/L^2; no penalty: a joint of Exudyn's without friction, moved along "
        "the contour until its force is normal to it"
    )

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> Readings:
        """By its static solver, station after station, past the contour itself: no mesh."""
        beam, cannot = case.beam, "exudyn cannot take it into account"
        if case.friction != 0:
            raise InputError("friction", case.friction, f"0: {cannot}", "leave it out")
        if beam.tip_radius not in (None, beam.radius):
            allowed = f"{beam.radius:g}: {cannot}"
            raise InputError("beam.tip_radius", beam.tip_radius, allowed, "leave it out")
        chosen = {"elements": settings.segments, "obstacle": "the contour, by a joint on it"}
        about = {
            "engine": f"Exudyn {version('exudyn')}, vibrissa-testbed {version('vibrissa-testbed')}",
            "settings": chosen,
        }

        def rest(leftward: Case) -> Rest:
            from engines.exudyn.contact import CableOnContour  # imports Exudyn

            return CableOnContour(leftward, settings.segments)

        with threadpool_limits(1):
            return sweep_stations(case, rest, "exudyn ANCF cable", about, advance)


ENGINE = _Exudyn()
