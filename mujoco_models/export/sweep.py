"""What is written, swept as it is: by MuJoCo's steps alone."""

from dataclasses import asdict, replace
from typing import Any

import mujoco

from analytic.problem.readings import Readings
from analytic.problem.recorder import leftward
from mujoco_models.beams.protocol import FOOT
from mujoco_models.dynamics.moving import SteppedModel
from mujoco_models.dynamics.record import StationMeans
from mujoco_models.dynamics.sweep import Passes, start_of
from mujoco_models.export.whisker import PREFIX, Whisker
from mujoco_models.model.clamp import Clamp, by_sensors
from mujoco_models.model.spec import compiled


def sweep_exported(whisker: Whisker) -> Readings:
    """Sweep what is written to the left past its obstacle, from the text of its file."""
    case, motion = whisker.case, whisker.motion
    model = _Written(beside(whisker))
    passes = Passes(
        model,
        case,
        motion,
        f"exported {whisker.settings.beam}",
        {"settings": asdict(whisker.settings)},
    )
    return passes.swept(_stations(whisker), lambda: None, lambda _: None)


def beside(whisker: Whisker) -> Whisker:
    """The vibrissa where its sweep begins, with the obstacle."""
    start = start_of(_stations(whisker), whisker.motion)
    return replace(whisker, start=start if whisker.case.sweep.direction == "left" else -start)


def _stations(whisker: Whisker) -> StationMeans:
    case = leftward(whisker.case)
    return StationMeans(case.foot_x / case.beam.length, whisker.motion.average)


class _Written(SteppedModel):
    """A model as MuJoCo reads it, moved by its motor."""

    def __init__(self, whisker: Whisker) -> None:
        read = compiled(mujoco.MjSpec.from_string(whisker.xml()))
        super().__init__(read, "mesh", whisker.period)
        self._unit, self._beam = whisker.case.beam.length / whisker.period, whisker.case.beam
        self._foot = self.model.body(PREFIX + FOOT).id
        mujoco.mj_forward(self.model, self.data)

    @property
    def p(self) -> float:
        """Where the foot is [L]."""
        return float(self.data.xpos[self._foot, 0]) / self._beam.length

    @property
    def touches(self) -> bool:
        """Whether a contact is loaded."""
        return bool(self.data.ncon and self.data.contact.dist.min() < 0)

    def clamp(self) -> Clamp:
        fx, fy, mz = Clamp.of(by_sensors(self.data))
        force, moment = self._beam.force_unit, self._beam.moment_unit
        return Clamp(fx / force, fy / force, mz / moment)

    def state(self, speed: float) -> dict[str, Any]:
        """Whether it touches; where, is not asked."""
        return {"phase": "tangent" if self.touches else "free", "status": "ok"}

    def step(self, speed: float) -> None:
        self.time = self.now
        self.data.ctrl[0] = -speed * self._unit
        self._advance()
