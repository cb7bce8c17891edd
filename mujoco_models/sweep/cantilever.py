"""A cantilever under a dead load at its tip: the textbook test of a beam and of its clamp."""

import math

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.beam import Beam
from analytic.problem.numbers import finite
from analytic.problem.support import Support
from mujoco_models.beams.kinds import build
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.model.spec import add_options
from mujoco_models.settings import Settings

_ITERATIONS = 50
_LARGEST_TURN = 0.5  # rad, of any link in one step
_TIP = "tip"


def load_tip(
    load: float, settings: Settings, vibrissa: Beam | None = None, clamp_stiffness: float = math.inf
) -> tuple[float, float]:
    """Tip of a clamped beam that carries a dead load across its undeformed axis.

    The load is MuJoCo's own, an actuator on a site; Newton's method on MuJoCo's balance finds the
    rest.
    """
    load, vibrissa = finite("load", load), vibrissa or Beam()
    beam = build(settings, 1.0, Vibrissa.of(vibrissa, Support(clamp_stiffness)))
    layout = beam.layout
    spec = beam.spec(Beam().radius)
    add_options(spec)
    last = len(layout.joints) - 1
    beam.body(spec, last).add_site(name=_TIP, pos=beam.within(last, np.ones(1))[0])
    spec.worldbody.add_site(name="world")
    actuator = spec.add_actuator(
        trntype=mujoco.mjtTrn.mjTRN_SITE, target=_TIP, refsite="world", gear=[load, 0, 0, 0, 0, 0]
    )
    actuator.set_to_motor()
    model = spec.compile()
    data = mujoco.MjData(model)
    data.ctrl[0] = 1

    angles: Floats = np.zeros(len(layout.joints))
    for _ in range(_ITERATIONS):
        beam.place(data, angles)
        mujoco.mj_forward(model, data)
        residual = beam.moments(data.qfrc_smooth + data.qfrc_constraint)
        x, y = data.site(_TIP).xpos[:2]
        if np.abs(residual).max() < settings.tolerance:
            rest_x, rest_y = layout.vibrissa.at(np.array(1.0))
            return float(x - rest_x), float(rest_y - y)
        # The load's lever turns with every joint below the outer one of two.
        reach = load * (x - data.xanchor[:, 0])
        outer = np.maximum.outer(np.arange(len(angles)), np.arange(len(angles)))
        step = np.linalg.solve(np.diag(beam.stiffness(angles)) + reach[outer], residual)
        turn = float(np.abs(np.cumsum(step)).max())
        angles = angles + step * min(1.0, _LARGEST_TURN / max(turn, 1e-300))
    raise RuntimeError(
        f"{settings.beam} under P L^2/EI = {load:g}: {np.abs(residual).max():.1e} EI/L out of "
        f"balance after {_ITERATIONS} steps"
    )
