"""Plain time stepping to the same balance: what one would write without `mujoco_models.sweep.rest`.

The very same model, tuned as well as it can be: the discrete integrator, implicit in springs and
contacts; every joint a critically damped oscillator with one and the same frequency; and, where
that is said, only the beads near the contact take part in collisions.
"""

import time
from collections.abc import Callable

import mujoco
import numpy as np
from rich.console import Console
from rich.table import Table

from analytic import Case, Sweep, named_case
from analytic.problem.clamp_path import along_x
from mujoco_models import Settings
from mujoco_models.model.model import BeamModel
from mujoco_models.sweep.sweep import set_out
from mujoco_models.sweep.walk import Walk

STATIONS = 100
CAP = 2_000  # steps a station
_STEP = 1e-3
_CHECK = 10  # steps
_SPACING = 4  # of the beads that look out while none is near


def main(quick: bool) -> None:
    """Both ways through the same stations, the last of them 2e-2 L before the catenary's fold."""
    case = named_case("catenary")
    stations = 4 if quick else STATIONS
    case = Case(case.beam, case.profile, Sweep(stations, stop=1.5 if quick else -2.55))
    table = Table(
        "way", "CPU ms a station", "slower by", "at rest", "largest residual",
        title=f"Chain of 40 to {Settings().tolerance:g} EI/L, {stations} stations of the catenary",
        caption=f"w: frequency times step; near: far beads do not collide; at most {CAP:,} steps",
    )  # fmt: skip
    ways: dict[str, Callable[[Walk[BeamModel]], np.ndarray]] = {
        "Newton": lambda walk: by_newton(walk, case),
        "stepping, w = 0.5": lambda walk: by_stepping(walk.model, case, 0.5, False),
        "near, w = 0.3": lambda walk: by_stepping(walk.model, case, 0.3, True),
        "near, w = 0.5": lambda walk: by_stepping(walk.model, case, 0.5, True),
        "near, w = 0.8": lambda walk: by_stepping(walk.model, case, 0.8, True),
    }
    least = None
    for way, go in ways.items():
        walk = set_out(case, Settings())
        begin = time.process_time()
        residuals = go(walk)
        took = time.process_time() - begin
        least = took if least is None else least
        table.add_row(
            way,
            f"{1e3 * took / stations:.1f}",
            f"{took / least:.0f}",
            f"{int((residuals < Settings().tolerance).sum())} of {stations}",
            f"{residuals.max():.1e}",
        )
    Console().print(table)


def by_newton(walk: Walk[BeamModel], case: Case) -> np.ndarray:
    """Residual at each station."""
    residuals = []
    for foot_x in case.foot_x:
        walk.go_to(float(foot_x))
        residuals.append(walk.row()["residual"])
    return np.array(residuals)


def by_stepping(model: BeamModel, case: Case, w: float, near: bool) -> np.ndarray:
    """Residual at each station; frequency times step is `w`."""
    compiled, data = model.model, model.data
    stiffness = compiled.jnt_stiffness
    stiffness = (stiffness if stiffness.ndim == 1 else stiffness[:, 0]).copy()
    compiled.dof_armature[:] = stiffness * (_STEP / w) ** 2
    compiled.dof_damping[:] = 2 * stiffness * _STEP / w
    compiled.opt.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
    compiled.opt.timestep = _STEP
    foot = compiled.body("foot").id
    angles = np.zeros(len(model.layout.joints))
    residuals = []
    for foot_x in case.foot_x:
        for step in range(CAP):
            if step % _CHECK == 0:
                velocity = data.qvel.copy()
                residual = float(np.abs(imbalance(model, float(foot_x), angles)).max())
                if residual < Settings().tolerance:
                    break
                data.qvel[:] = velocity
                look(model, near)
            compiled.body_pos[foot, 0] = foot_x
            mujoco.mj_step(compiled, data)
            angles = data.qpos.copy()
        residuals.append(residual)
    return np.array(residuals)


def imbalance(model: BeamModel, foot_x: float, angles: np.ndarray) -> np.ndarray:
    """Moments in MuJoCo's own terms: under `discrete` contacts have another stiffness than ours."""
    model.move_clamp(along_x(0.0).at(np.array(foot_x)))
    model.beam.place(model.data, angles)
    model.data.qvel[:] = 0
    mujoco.mj_forward(model.model, model.data)
    return model.beam.moments(model.moments())


def look(model: BeamModel, near: bool) -> None:
    """Use the mesh that is fine at the contact; let only beads `near` the obstacle collide."""
    if near:
        positions = model.bead_positions(np.arange(len(model.layout.beads)))
        close = model.obstacle.near(positions, model.radius + 1e-3)
        far = range(0, len(positions), _SPACING)
        model.lookout.watch(frozenset(close.tolist()) or frozenset(far))
    model.lookout.follow_contact(model.contacts())
