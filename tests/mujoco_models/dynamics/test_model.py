"""The beam with its mass: its free vibration, and what its clamp feels."""

import mujoco
import numpy as np
import pytest
from scipy.linalg import eigh

from analytic import Case, Sweep, circle
from mujoco_models import Motion, Settings
from mujoco_models.beams.kinds import build
from mujoco_models.dynamics.model import MovingModel
from mujoco_models.obstacles.kinds import place

FAR = Case(profile=circle(1.0, (0.0, 0.9)), sweep=Sweep(3, 5.0, 4.0), name="far")


def moving(motion, settings=None, case=FAR, foot_x=5.0):
    settings = settings or Settings(segments=20, contour_points=100)
    beam = build(settings, 0.05)
    return MovingModel(beam, {"obstacle0": place(case, settings)}, motion, case, foot_x)


def first_period(segments):
    """Of the free vibration with the foot at rest, from MuJoCo's masses and stiffnesses."""
    model = moving(Motion(), Settings(segments=segments, contour_points=100)).model
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    inertia = np.zeros((model.nv, model.nv))
    for row, unit in zip(inertia, np.eye(model.nv), strict=True):
        mujoco.mj_mulM(model, data, row, unit)
    stiffness = np.diag(model.jnt_stiffness[1:])
    return 2 * np.pi / np.sqrt(eigh(stiffness, inertia[1:, 1:], eigvals_only=True)[0])


def test_the_first_period_is_the_unit_of_time():
    # The first root of cos(x) cosh(x) = -1, 1.8751, is that of a uniform cantilever: S. S. Rao,
    # Mechanical Vibrations. Observed -2.0e-3, -4.2e-4 and -5.4e-5.
    error = [first_period(n) - 1 for n in (10, 20, 40)]
    assert np.abs(error).max() < 3e-3
    assert abs(error[1]) < abs(error[0]) / 3.5
    assert abs(error[2]) < abs(error[1]) / 3.5


def test_the_dampers_take_as_much_as_their_ratio_says():
    motion = Motion(timestep=1e-3, damping_ratio=0.05)
    model = moving(motion)
    s = model.data.xanchor[1:, 1]
    model.data.qpos[1:] = 1e-3 * (1 - s) ** 2 / 20
    moments = []
    for _ in range(4000):
        model.step(0.0)
        moments.append(model.clamp().moment_z)
    peaks = [np.abs(moments[i : i + 1000]).max() for i in (1000, 2000, 3000)]
    # exp(-2 pi zeta/sqrt(1 - zeta^2)) a period; the integrator adds its own, of the order of dt.
    expected = np.exp(-2 * np.pi * 0.05)
    assert np.divide(peaks[1:], peaks[:-1]) == pytest.approx([expected] * 2, rel=0.03)


def test_a_free_vibrissa_at_constant_speed_loads_no_clamp():
    model = moving(Motion(timestep=0.01, damping_ratio=1.0))
    for i in range(2000):
        model.step(0.5 * min(1, i / 400))
    # The last step began at 19.99 T1; the way of the start is half of what it takes.
    assert model.p == pytest.approx(5 - 0.5 * (19.99 - 4 / 2), abs=0.01)
    for reading in model.clamp():
        assert abs(reading) < 1e-6
    assert model.kinetic_share() < 1


def test_the_clamp_accelerates_the_vibrissa_and_not_the_foot():
    """Newton: force_x is the rate of the vibrissa's momentum."""
    model = moving(Motion(timestep=1e-4, damping_ratio=0.0))
    mass = model.model.body_mass.sum()
    momentum, forces = [], []
    for i in range(4000):
        model.step(0.5 * min(1, i / 2000))
        forces.append(model.clamp().force_x)
        mujoco.mj_subtreeVel(model.model, model.data)
        momentum.append(mass * model.data.subtree_linvel[0, 0])
    impulse = np.cumsum(forces) * 1e-4
    assert np.abs(momentum).max() > 0.1
    # A step's impulse, by which sensors and speeds may be apart, is 1e-4 times the largest force.
    np.testing.assert_allclose(momentum, impulse, atol=3e-4 * np.abs(forces).max())
