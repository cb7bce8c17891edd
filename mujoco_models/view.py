"""The sweep in MuJoCo's interactive viewer."""

import time
import warnings

import glfw
import mujoco
import mujoco.viewer
import numpy as np

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.recorder import leftward
from mujoco_models.model.model import BeamModel
from mujoco_models.obstacles.protocol import GEOM
from mujoco_models.settings import Settings
from mujoco_models.sweep.sweep import set_out

_PAUSE = 0.04  # s, after every station
_BODY, _VIBRISSA = (0.7, 0.72, 0.76, 0.5), (0.95, 0.65, 0.0, 1.0)
_HIDDEN = (0.0, 0.0, 0.0, 0.0)
_ARROW = 0.04  # L for a force of EI/L^2 at one bead
_WIDTH_TO_HEIGHT = 1.6  # of the window, about
_THICK = 0.012  # L; the radius that a vibrissa is drawn with is at least this


def show(case: Case, settings: Settings) -> None:
    """Open the viewer; see `mujoco_models.view_sweep`.

    A sweep to the right is simulated as its mirror image, so it is looked at from behind.
    """
    _ask_for_display()
    to_right, to_left = case.direction == "right", leftward(case)
    walk = set_out(to_left, settings)
    model, data = walk.model.model, walk.model.data
    foot_x = to_left.foot_x / to_left.beam.length
    stage = _Stage(walk.model, height=max(1.3, (np.ptp(foot_x) + 1) / _WIDTH_TO_HEIGHT))
    with mujoco.viewer.launch_passive(
        model, data, show_left_ui=False, show_right_ui=False
    ) as viewer:
        with viewer.lock():
            stage.light(viewer.opt)
            _aim(viewer.cam, model, float(foot_x.mean()), to_right)
        for target in to_left.way:
            with viewer.lock():
                walk.go_to(float(target))
            stage.dress(viewer)
            if not viewer.is_running():
                return
            viewer.sync()
            time.sleep(_PAUSE)
        while viewer.is_running():
            time.sleep(_PAUSE)


class _Stage:
    """What is seen of the model: the obstacle, and the links."""

    def __init__(self, beam: BeamModel, height: float) -> None:
        model = beam.model
        self._mesh = int(model.geom_dataid[model.geom(GEOM).id])
        model.geom_rgba[model.geom(GEOM).id] = _BODY
        model.geom_rgba[model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE] = _HIDDEN
        links = model.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE
        model.geom_rgba[links] = _VIBRISSA
        model.geom_size[links, 0] = np.maximum(model.geom_size[links, 0], _THICK)
        model.vis.map.force = _ARROW * model.stat.meanmass  # which MuJoCo divides by
        model.vis.scale.forcewidth = 0.02 / model.stat.meansize
        model.vis.headlight.ambient[:] = 0.4
        model.vis.global_.fovy = height  # a length: the camera has no perspective

    def light(self, options: mujoco.MjvOption) -> None:
        """Show the meshes' hulls, which is what collides, and the contact forces."""
        options.flags[mujoco.mjtVisFlag.mjVIS_CONVEXHULL] = True
        options.flags[mujoco.mjtVisFlag.mjVIS_CONTACTFORCE] = True

    def dress(self, viewer: mujoco.viewer.Handle) -> None:
        """Show the mesh as it is now: its vertices follow the contact."""
        if self._mesh >= 0:
            viewer.update_mesh(self._mesh)


def _aim(camera: mujoco.MjvCamera, model: mujoco.MjModel, centre: float, behind: bool) -> None:
    """Look along z, x to the right and y upwards; from behind, x to the left."""
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    camera.orthographic = 1
    camera.lookat = np.array([centre, 0.5, 0.0])
    camera.azimuth, camera.elevation = (-90, 90) if behind else (90, -90)
    camera.distance = model.stat.extent  # outside of the obstacle, however long it is


def _ask_for_display() -> None:
    """Find out before the viewer does, in a thread that would wait for ever."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if glfw.init():
            return
    raise InputError(
        "display",
        "none",
        "a screen for MuJoCo's viewer",
        "`vibrissa run CASE --film` draws the sweep without one",
    )
