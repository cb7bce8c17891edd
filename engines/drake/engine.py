"""Drake's chain as an engine: a twin of MuJoCo's."""

import time
from collections.abc import Callable
from dataclasses import asdict
from importlib.metadata import version

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.mirror import facing, leftward
from analytic.problem.readings import Readings
from engines.engine import Role
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
        if settings.beam != "chain" or not settings.planar:
            kind = settings.beam if settings.planar else f"{settings.beam} out of the plane"
            raise InputError(
                "beam for drake", repr(kind), "'chain' in the plane", "take --beam chain"
            )
        return facing(case, _sweep(leftward(case), settings, advance))


def _sweep(case: Case, settings: Settings, advance: Callable[[], None]) -> Readings:
    from engines.drake.chain import DrakeChain  # Drake is imported only where it is used
    from mujoco_models.model.parts import parts_at_rest
    from mujoco_models.sweep.sweep import follow
    from mujoco_models.sweep.walk import Walk

    begun = time.process_time()
    beam, obstacle = parts_at_rest(case, settings, "drake")
    chain = DrakeChain(beam, case.radius, obstacle, settings.contact_stiffness)
    walk = Walk(chain, float(case.foot_x[0]) / case.beam.length, settings.tolerance)
    about = {
        "engine": f"Drake {version('drake')}, vibrissa-testbed {version('vibrissa-testbed')}",
        "settings": asdict(settings),
    }
    return follow(case, walk, "drake chain", about, begun, advance)


ENGINE = _Drake()
