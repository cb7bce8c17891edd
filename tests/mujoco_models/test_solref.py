"""A contact's stiffness and damping in MuJoCo's own steps, from its parameters and back."""

import mujoco
import numpy as np
import pytest

from analytic import InputError
from mujoco_models import from_solref, to_solref

MASS, STIFFNESS, DAMPING = 0.2, 5e3, 300.0
KINDS = {"ball": 'type="sphere" size="0.02"', "box": 'type="box" size="0.02 0.02 0.02"'}


def dropped(solref, solimp, kind="ball", integrator="implicitfast", armature=0.0, timestep=1e-4):
    """A body of 0.2 kg on a slide above a plane, as it touches."""
    texts = [" ".join(map(str, numbers)) for numbers in (solref, solimp)]
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{timestep}" gravity="0 0 0" integrator="{integrator}"/>'
        f'<default><geom solref="{texts[0]}" solimp="{texts[1]}" condim="1"/></default>'
        '<worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 0.02">'
        f'<joint type="slide" axis="0 0 1" armature="{armature}"/>'
        f'<geom {KINDS[kind]} mass="{MASS}"/></body></worldbody></mujoco>'
    )
    return model, mujoco.MjData(model)


def at_rest(model, data, force):
    """Depth of the deepest contact, and the force of each by `mj_contactForce`."""
    data.qfrc_applied[0] = -force
    for _ in range(round(4 / model.opt.timestep)):
        mujoco.mj_step(model, data)
    assert abs(data.qvel[0]) < 1e-9
    wrench, forces = np.zeros(6), []
    for i in range(data.ncon):
        mujoco.mj_contactForce(model, data, i, wrench)
        forces.append(wrench[0])
    return -float(data.contact.dist.min()), np.array(forces)


@pytest.mark.parametrize("impedance", [0.5, 0.9, 0.99])
@pytest.mark.parametrize("force", [1.0, 10.0])
def test_depth_is_force_over_stiffness(impedance, force):
    solref, solimp = to_solref(STIFFNESS, DAMPING, 1 / MASS, impedance)
    depth, forces = at_rest(*dropped(solref, solimp), force)
    assert forces.sum() == pytest.approx(force, rel=1e-6)
    assert depth == pytest.approx(force / STIFFNESS, rel=1e-6)
    assert from_solref(solref, solimp, 1 / MASS) == pytest.approx((STIFFNESS, DAMPING))


@pytest.mark.parametrize(
    ("solref", "solimp"),
    [
        ((0.02, 1.0), (0.9, 0.95, 0.001)),  # MuJoCo's defaults
        pytest.param((0.01, 0.7), (0.8, 0.99, 0.002, 0.3, 3), marks=pytest.mark.slow),
        pytest.param((0.01, 1.0), (0.9, 0.99, 0.002, 0.5, 1), marks=pytest.mark.slow),
        ((-2e3, -50.0), (0.7, 0.9, 0.001)),
        ((0.01, -1.0), (0.9, 0.95, 0.001)),  # of a mixture MuJoCo takes its default
    ],
)
def test_the_stiffness_of_any_parameters_is_what_is_stepped(solref, solimp):
    for force in (0.05, 0.5, 5.0):
        depth, _ = at_rest(*dropped(solref, solimp), force)
        stiffness, _ = from_solref(solref, solimp, 1 / MASS, depth)
        assert depth == pytest.approx(force / stiffness, rel=1e-5)


def test_damping_is_force_over_speed():
    """At no depth, in the first step, a body that nothing holds is slowed by its damping alone."""
    solref, solimp = to_solref(STIFFNESS, DAMPING, 1 / MASS, impedance=0.9)
    model, data = dropped(solref, solimp)
    data.qpos[0], data.qvel[0] = -1e-12, -0.01
    mujoco.mj_forward(model, data)
    # It moves as if it had 1/(1 - d) of its mass: the stiffness is that at rest.
    assert data.qacc[0] == pytest.approx(DAMPING * 0.01 * (1 - 0.9) / MASS, rel=1e-6)


def test_contacts_share_a_load():
    solref, solimp = to_solref(STIFFNESS, DAMPING, 1 / MASS)
    depth, forces = at_rest(*dropped(solref, solimp, "box"), 10.0)
    assert len(forces) == 4
    assert depth == pytest.approx(10.0 / (4 * STIFFNESS), rel=1e-6)


def test_armature_is_mass():
    """The same solref is softer by as much as the joint's inertia is larger."""
    solref, solimp = to_solref(STIFFNESS, DAMPING, 1 / MASS)
    model, data = dropped(solref, solimp, armature=0.6)
    weight = float(model.body_invweight0[1, 0])
    stiffness, _ = from_solref(solref, solimp, weight)
    depth, _ = at_rest(model, data, 10.0)
    assert depth == pytest.approx(10.0 / stiffness, rel=1e-6)


@pytest.mark.parametrize("timestep", [1e-3, 5e-3])
def test_discrete_takes_springs_and_dampers_for_mass(timestep):
    """It counts h c + h^2 k of a joint as mass; without them the same solref is as stiff."""
    spring, damper = 1e3, 20.0
    solref, solimp = to_solref(STIFFNESS, DAMPING, 1 / MASS)
    for k, c in ((0.0, 0.0), (spring, damper)):
        model, data = dropped(solref, solimp, integrator="discrete", timestep=timestep)
        model.jnt_stiffness[0], model.dof_damping[0] = k, c
        depth, forces = at_rest(model, data, 100.0)
        mass = MASS + timestep * c + timestep**2 * k
        stiffness, _ = from_solref(solref, solimp, 1 / mass)
        assert forces[0] / depth == pytest.approx(stiffness, rel=1e-6)


@pytest.mark.parametrize(
    "given", [(0.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, np.inf), (1.0, 1.0, 1.0, 1.0)]
)
def test_no_contact_at_all_is_a_line(given):
    with pytest.raises(InputError, match="must be"):
        to_solref(*given)
