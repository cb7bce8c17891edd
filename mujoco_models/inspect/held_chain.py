"""A chain of a user's model with its foot held: its states at rest, by Newton's method."""

from collections.abc import Callable

import mujoco
import numpy as np
from scipy.linalg import eigh

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.errors import InputError
from mujoco_models.inspect.held import Bending, HeldModel
from mujoco_models.inspect.parts import Parts, axis_of

_STEP = 1e-6  # rad; MuJoCo's forces are smooth there, and exact to 1e-14 of their size
_ITERATIONS = 100
_LONGEST_TURN = 0.2  # rad, of any coordinate in an iteration
_SOFTEST = 1e-9  # of the stiffest joint; what is softer, nothing holds
_NONE = np.zeros(0, int)
_BARE = 0.75  # of a link: a first piece without a geom, as half of a cell is
_AT_REST = 1e-9  # of a joint's stiffness: rad by which it is out of balance
_ROUNDING = 1e-15  # likewise
# All of MuJoCo that forces take without constraints; factors of the inertia cost ten times that.
_STAGES = (
    mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_flex, mujoco.mj_tendon, mujoco.mj_collision,
    mujoco.mj_makeConstraint, mujoco.mj_transmission, mujoco.mj_fwdVelocity,
    mujoco.mj_fwdActuation,
)  # fmt: skip


class HeldChain(HeldModel):
    """Links on hinges or balls, and coordinates of the hand that are not held."""

    small = 1e-4

    def __init__(self, model: mujoco.MjModel, parts: Parts, hand: Integers = _NONE) -> None:
        moves = np.isin(model.dof_bodyid, parts.chain)
        moves[hand] = True
        super().__init__(model, parts, np.flatnonzero(moves), np.flatnonzero(~moves))
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS
        self.model.opt.tolerance = 0
        self._tip_body = parts.chain[-1]
        self._slope = np.full((len(self.dofs), len(self.dofs)), np.nan)
        self.set_back()

    def set_back(self) -> None:
        """And find the tip again."""
        super().set_back()
        # What is farthest from the last joint; the last of its geoms may be a ball on it.
        ends = self._ends(self.parts.geoms[-1])
        joint = self.data.xanchor[self.model.body_jntadr[self._tip_body]]
        far = ends[int(np.argmax(np.linalg.norm(ends - joint, axis=1)))]
        from_body = far - self.data.xpos[self._tip_body]
        self.tip_in_body = self.axes_of(self._tip_body).T @ from_body

    def _ends(self, geom: int) -> Floats:
        """Of the axes of a geom and of all that are fixed to it."""
        owners = self.model.geom_bodyid[list(self.parts.geoms)]
        mine = self.model.body_weldid[owners] == self.model.body_weldid[self._body(geom)]
        return np.concatenate([
            self._world(axis_of(self.model, one), self._body(one))
            for one in np.array(self.parts.geoms)[mine].tolist()
        ])  # fmt: skip

    def _body(self, geom: int) -> int:
        return int(self.model.geom_bodyid[geom])

    def _world(self, points: Floats, body: int) -> Floats:
        return np.asarray(self.data.xpos[body] + points @ self.axes_of(body).T)

    @property
    def tip(self) -> Floats:
        """Where the tip is, shape (3,)."""
        return np.asarray(self._world(self.tip_in_body[None], self._tip_body)[0])

    def turn_by(self, load: Callable[[], None]) -> Floats:
        """How far a load turns its last link from where it rests without one [rad], shape (3,)."""
        self.unload()
        was, axes = self.data.xquat[self._tip_body].copy(), self.axes_of(self._tip_body).copy()
        load()
        self.rest()
        turn = np.empty(3)
        mujoco.mju_subQuat(turn, self.data.xquat[self._tip_body], was)  # in its axes before
        self.unload()
        return np.asarray(axes @ turn)

    @property
    def clamp(self) -> Floats:
        """Where the vibrissa begins: the end of its first geoms that is farthest from the tip.

        Of a plugin's chain, whose first cell nothing makes bend, in it if the sensor is there; and
        at a sensor behind the first hinge, if the piece between them has no geom.
        """
        ends = self._ends(self.parts.geoms[0])
        near, far = ends[np.argsort(np.linalg.norm(ends - self.tip, axis=1))][[0, -1]]
        if self.parts.plugin:
            return self.begin(far, near)
        if self.model.body_weldid[self._body(self.parts.geoms[0])] != self.parts.chain[0]:
            return np.asarray(far)
        first, second = self.joints[:2]
        behind = far - _BARE * (second - first)
        found = self.begin(behind, far)
        return np.asarray(far) if np.array_equal(found, behind) else found

    @property
    def joints(self) -> Floats:
        """Where its bodies are hinged, shape (n_links, 3)."""
        first = self.model.body_jntadr[list(self.parts.chain)]
        return np.array(self.data.xanchor[first])

    def evaluate(self) -> Floats:
        """What is out of balance at rest."""
        self.data.qvel[:] = 0
        return self._forces()

    def _forces(self) -> Floats:
        """All that acts on its coordinates at the present place and speed."""
        for stage in _STAGES:
            stage(self.model, self.data)
        if self.data.nefc:  # what these hold with goes with the inertia, not with how it is solved
            option = self.model.opt
            solver = option.solver, option.iterations
            option.solver, option.iterations = int(mujoco.mjtSolver.mjSOL_CG), 0
            mujoco.mj_forward(self.model, self.data)
            option.solver, option.iterations = solver
        forces = self.data.qfrc_passive + self.data.qfrc_actuator - self.data.qfrc_bias
        forces += self._constrained()
        load = self._force, self._torque
        mujoco.mj_applyFT(self.model, self.data, *load, self.tip, self._tip_body, forces)
        return np.asarray(forces[self.dofs])

    def _sense(self) -> None:
        """All of MuJoCo's evaluation at rest, with the load on the tip where that is."""
        moment = np.empty(3)
        mujoco.mju_cross(moment, self.tip - self.data.xipos[self._tip_body], self._force)
        self.data.xfrc_applied[self._tip_body] = [*self._force, *(self._torque + moment)]
        mujoco.mj_forward(self.model, self.data)

    def _constrained(self) -> Floats:
        """What welds, limits and other constraints hold with where nothing accelerates."""
        data, forces = self.data, np.zeros(self.model.nv)
        if data.nefc:
            held = data.efc_D * data.efc_aref
            pushes = data.efc_type > int(mujoco.mjtConstraint.mjCNSTR_FRICTION_TENDON)
            held[pushes] = np.maximum(held[pushes], 0)
            mujoco.mj_mulJacTVec(self.model, data, forces, held)
        return forces

    def stiffness(self) -> Floats:
        """How what is out of balance falls with each turn, at the present state."""
        start = self.data.qpos.copy()

        def turned(turn: Floats) -> Floats:
            self.data.qpos[:] = start
            mujoco.mj_integratePos(self.model, self.data.qpos, turn, 1.0)
            return self.evaluate()

        slope = self._slope_of(turned)
        self.data.qpos[:] = start
        self.evaluate()
        return slope

    def _damping(self) -> Floats:
        """How the passive forces fall with each joint's speed, shape (n, n)."""

        def moving(speed: Floats) -> Floats:
            self.data.qvel[:] = speed
            return self._forces()

        slope = self._slope_of(moving)
        self.evaluate()
        return slope

    def slopes(self) -> tuple[Floats, Floats, Floats]:
        """Stiffness, damping and inertia at the present state, shape (n, n) each."""
        return self.stiffness(), self._damping(), self._inertia(armature=True)

    def _slope_of(self, force: Callable[[Floats], Floats]) -> Floats:
        """How a force falls with each coordinate's change, by central differences."""
        steps = _STEP * np.eye(self.model.nv)[self.dofs]
        both = [(force(step), force(-step)) for step in steps]
        return np.array([(behind - ahead) / (2 * _STEP) for ahead, behind in both]).T

    def unload(self) -> None:
        """Take loads away and put the vibrissa to rest as it is by itself."""
        self.set_back()
        self.rest()

    def rest(self) -> None:
        """Let the vibrissa come to rest under its loads, by Newton's method.

        A slope serves as long as its steps halve what is out of balance, those of other loads too;
        and they go on to where rounding stops them, since sensors are probed by small loads.
        """
        before = np.inf
        for _ in range(_ITERATIONS):
            residual = self.evaluate()
            out = self._out_of_balance(residual)
            if not out < before / 2 or out < _ROUNDING:
                if out < _AT_REST:
                    self._sense()
                    return
                self._slope = self._checked(self.stiffness())
                out = self._out_of_balance(residual)
            step = np.zeros(self.model.nv)
            step[self.dofs] = np.linalg.solve(self._slope, residual)
            step *= _LONGEST_TURN / max(np.abs(step / self.units).max(), _LONGEST_TURN)
            mujoco.mj_integratePos(self.model, self.data.qpos, step, 1.0)
            before = out
        raise InputError(
            "model",
            f"out of balance by {out:.1e} rad",
            "one that comes to rest with its foot held",
            "look at its joints' limits and equality constraints",
        )

    def _out_of_balance(self, residual: Floats) -> float:
        """By how much its joints would have to turn, at most [rad]; NaN without a slope yet."""
        return float(np.abs(residual / np.diag(self._slope) / self.units[self.dofs]).max())

    def _checked(self, slope: Floats) -> Floats:
        """A slope all of whose joints something holds, or raise InputError."""
        if not np.isfinite(slope).all():
            raise InputError(
                "model", "with moments that are not finite", "one that has a state at rest",
                "if it is a cable of MuJoCo 3 on a mocap body, put that on a slide: its plugin "
                "reads the body's place before MuJoCo has written it",
            )  # fmt: skip
        scale = np.abs(np.diag(slope)) * self.units[self.dofs] ** 2
        least, most = int(np.argmin(scale)), int(np.argmax(scale))
        if _SOFTEST * scale[most] > np.median(scale) > 0:
            raise InputError(
                self._body_of(most), "so stiff that the others are nothing beside it",
                "less than 1e9 times as stiff as they are", "correct its joint's stiffness",
            )  # fmt: skip
        if not scale[least] > _SOFTEST * scale[most]:
            raise InputError(
                self._body_of(least), "without a stiffness", "held by a spring",
                "give its joint a stiffness, or the bodies an elasticity plugin with bend and "
                "twist; URDF has neither: save it as MJCF first",
            )  # fmt: skip
        return slope

    def _body_of(self, dof: int) -> str:
        """What an error calls the body of one of the vibrissa's coordinates."""
        name = self.model.body(self.model.dof_bodyid[self.dofs[dof]]).name
        return f"body {name!r} of the vibrissa"

    def bending(self, axes: Floats) -> Bending:
        """How it bends and vibrates about its present state, by its stiffness and inertia."""
        stiffness = self.stiffness()
        flexibility = np.linalg.inv(stiffness)
        turns = self._turns(axes[2])
        links = turns @ flexibility @ turns[-1]  # turns under a unit moment on the tip
        way = axes[0] @ self._moves()
        inertias = [self._inertia(armature) for armature in (True, False)]
        try:
            (squares, modes), (bare, shapes) = (eigh(stiffness, inertia) for inertia in inertias)
        except (np.linalg.LinAlgError, ValueError) as error:  # of no inertia, or of an infinite one
            raise InputError(
                "masses of the vibrissa", "such that it has no vibrations",
                "positive, and not 1e15 times apart", "correct masses, densities and sizes",
            ) from error  # fmt: skip
        if not squares[0] > 0:
            raise InputError(
                self._body_of(int(np.argmax(np.abs(modes[:, 0])))),
                "pushed away from its place by its own spring", "held there",
                "give its joint a positive stiffness",
            )  # fmt: skip
        return Bending(
            compliances=np.diff(links, prepend=0.0),
            tip_compliance=float(way @ flexibility @ way),
            squares=squares,
            damping=np.einsum("im,ij,jm->m", modes, self._damping(), modes),
            slowest_without_armature=float(bare[_slowest(bare, way @ shapes)]),
            first=_slowest(squares, way @ modes),
        )

    def _inertia(self, armature: bool) -> Floats:
        """The mass matrix of the vibrissa on its held foot, shape (n, n)."""
        unit = np.eye(self.model.nv)[self.dofs]
        found = np.zeros_like(unit)
        for row, turn in zip(found, unit, strict=True):
            mujoco.mj_mulM(self.model, self.data, row, turn)
        own = 0.0 if armature else np.diag(self.model.dof_armature[self.dofs])
        return np.asarray(found[:, self.dofs] - own)

    def _turns(self, axis: Floats) -> Floats:
        """How each link turns about an axis with the coordinates, shape (n_links, n)."""
        rotation = np.zeros((3, self.model.nv))
        rows = []
        for body in self.parts.chain:
            mujoco.mj_jacBody(self.model, self.data, None, rotation, body)
            rows.append(axis @ rotation[:, self.dofs])
        return np.array(rows)

    def _moves(self) -> Floats:
        """How the tip moves with the coordinates, shape (3, n)."""
        way = np.zeros((3, self.model.nv))
        mujoco.mj_jac(self.model, self.data, way, None, self.tip, self._tip_body)
        return np.asarray(way[:, self.dofs])


def _slowest(squares: Floats, of_the_tip: Floats) -> int:
    """Which vibration bends it: the one by which the tip gives way most; a twist is no bending."""
    return int(np.argmax(of_the_tip**2 / squares))
