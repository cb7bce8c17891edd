"""A flex of a user's model with its foot held: loads on it, and its states at rest.

Its edges keep their lengths, and a weld its angle, by constraints that are soft, and under
``discrete`` as soft as the step makes them: only steps of MuJoCo's own say where it is at rest. How
far the edges stretch is measured first; then they are held as well as MuJoCo can.
"""

import math
from copy import copy

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from mujoco_models.inspect.drive import holders
from mujoco_models.inspect.held import Bending, HeldModel, lengths
from mujoco_models.inspect.parts import Parts
from mujoco_models.inspect.rod import Rod

_FIRST = 1.8751040687119611**2  # omega L^2 sqrt(m/EI) of the first vibration of a cantilever
_AT_REST = 1e-8  # L in 1/omega
_SHORTEST, _LONGEST = 3.0, 600.0  # 1/omega to come to rest in
_SHORTEST_STEP = 1 / 20_000  # of the first period: a rod is measured by steps, two million at most
_FADES = 30.0  # time constants of a weld, in which all of a heavy foot's motion is gone
_PULLED = 60.0  # 1/omega; what is not at rest by then, stretches too far anyway
_SMALL = 1e-2  # EI/L^2 and EI/L; what bends by so little does so linearly, to 1e-4
_TINY = 1e-3  # likewise, for what stretches; and the strain that is linear
_HARD = 0.9999  # impedance; MuJoCo takes no more
_TOLERANCE = 1e-16  # of MuJoCo's solver; with 0 it warns that it does not get there


class HeldRod(HeldModel):
    """A flex of dimension 1."""

    small = _TINY

    def __init__(self, model: mujoco.MjModel, parts: Parts, rod: Rod) -> None:
        self.rod = rod
        # The hand is: what is welded to it moves as far as its weld lets it.
        free = model.jnt_type[model.dof_jntid] == mujoco.mjtJoint.mjJNT_FREE
        hand = np.isin(model.dof_bodyid, [*holders(model, parts.foot)])
        mine = np.isin(model.dof_bodyid, parts.chain)
        super().__init__(model, parts, np.flatnonzero(mine), np.flatnonzero(hand & ~free))
        self.model.opt.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
        self.model.opt.solver = mujoco.mjtSolver.mjSOL_NEWTON
        self.model.opt.tolerance = _TOLERANCE
        self._unloaded: mujoco.MjData | None = None  # at rest, once it is known
        welds = model.eq_type == mujoco.mjtEq.mjEQ_WELD
        self._shortest = _FADES * float(model.eq_solref[welds, 0].max(initial=0.0))
        self.set_back()
        self._length = float(lengths(self.vertices).sum())
        self._rigidity = self._nominal_rigidity()
        mass = self._masses.sum() / self._length
        self._omega = _FIRST / self._length**2 * math.sqrt(self._rigidity / mass)
        shortest = _SHORTEST_STEP * 2 * math.pi / self._omega
        if model.opt.timestep < shortest:
            allowed = f"at least {shortest:.2g}, {_SHORTEST_STEP:g} of the rod's first period"
            remedy = "a rod is measured by its own steps: take a longer one"
            raise InputError("timestep", f"{model.opt.timestep:g}", allowed, remedy)
        # Critical for the first vibration; all others fade as fast.
        of_vertex = model.body_mass[model.dof_bodyid[self.dofs]]
        self.model.dof_damping[self.dofs] += 2 * self._omega * of_vertex
        self._stretch = self._measure_stretch()
        self._stiffen_edges()

    @property
    def vertices(self) -> Floats:
        """Where its vertices are, shape (n, 3)."""
        return np.array(self.data.flexvert_xpos[list(self.rod.vertices)])

    @property
    def tip(self) -> Floats:
        """Where the tip is, shape (3,)."""
        return np.asarray(self.vertices[-1])

    @property
    def joints(self) -> Floats:
        """Where it bends, shape (n - 2, 3)."""
        return np.asarray(self.vertices[1:-1])

    @property
    def clamp(self) -> Floats:
        """Where the vibrissa begins: at the torque sensor, if the first edge goes past that."""
        return self.begin(*self.vertices[:2])

    def unload(self) -> None:
        """Take loads away and put the rod to rest as it is by itself."""
        self.set_back()
        if self._unloaded is None:
            self.rest()
            self._unloaded = copy(self.data)
        mujoco.mj_copyData(self.data, self.model, self._unloaded)

    def rest(self) -> None:
        """Let the vibrissa come to rest under its loads, by steps of MuJoCo's."""
        if not self._settles(_LONGEST):
            name = mujoco.mj_id2name(self.model, mujoco.mjtObj.mjOBJ_FLEX, self.rod.flex)
            raise InputError(
                f"flex {name!r}", f"moving after {_LONGEST / (2 * math.pi):.0f} first periods",
                "one that comes to rest with its foot held",
                "stiffen its edges (<edge solref=.../>), or shorten the time step",
            )  # fmt: skip

    def _settles(self, longest: float) -> bool:
        """Whether it comes to rest within a time [1/omega]."""
        step, slow = self.model.opt.timestep, _AT_REST * self._length * self._omega
        shortest = max(_SHORTEST / self._omega, min(self._shortest, _LONGEST / self._omega))
        self._apply()
        turns = self._torque.any()
        for i in range(math.ceil(max(longest / self._omega, 2 * shortest) / step)):
            if turns:  # its couple goes with the last edge
                self._apply()
            mujoco.mj_step(self.model, self.data)
            speed = float(np.abs(self.data.qvel[self.dofs]).max())
            if speed < slow and i * step > shortest:
                return True
        return False

    def _apply(self) -> None:
        """A vertex does not turn: a moment is a couple on the last two, but for what twists."""
        applied, chain = self.data.xfrc_applied, self.parts.chain
        applied[:] = 0
        applied[chain[-1], :3] = self._force
        before, tip = self.data.flexvert_xpos[list(self.rod.vertices[-2:])]
        edge = tip - before
        square = edge @ edge
        couple = np.empty(3)
        mujoco.mju_cross(couple, self._torque, edge)  # np.cross would take longer than the step
        couple /= square
        applied[chain[-1], :3] += couple
        applied[chain[-2], :3] -= couple
        applied[self.parts.foot, 3:] = (self._torque @ edge) * edge / square

    def _nominal_rigidity(self) -> float:
        """EI by the force on the tip of MuJoCo's where the rod is bent to an arc."""
        vertices = self.vertices
        s = np.append(0, np.cumsum(lengths(vertices)))[2:]
        along = (vertices[1] - vertices[0]) / np.linalg.norm(vertices[1] - vertices[0])
        ways = np.cross(along, np.cross(self._slides(), along))
        across = ways[int(np.argmax(np.linalg.norm(ways, axis=1)))]
        across /= np.linalg.norm(across)
        bent = dict(zip(self.parts.chain, _SMALL / self._length * s**2 / 2, strict=True))
        arc = mujoco.MjData(self.model)
        joints = np.flatnonzero(np.isin(self.model.jnt_bodyid, self.parts.chain))
        sidewards = self.data.xaxis[joints] @ across
        for joint, share in zip(joints, sidewards, strict=True):
            way = bent[int(self.model.jnt_bodyid[joint])]
            arc.qpos[self.model.jnt_qposadr[joint]] += share * way
        mujoco.mj_forward(self.model, arc)
        last = self.model.jnt_bodyid[joints] == self.parts.chain[-1]
        forces = arc.qfrc_passive[self.model.jnt_dofadr[joints[last]]]
        return float(-forces @ sidewards[last] * (s[-1] - s[-2]) * self._length / _SMALL)

    def _slides(self) -> Floats:
        """Axes of the slides of the last vertex, in rows: three, or two in a plane."""
        first = self.model.body_jntadr[self.parts.chain[-1]]
        count = self.model.body_jntnum[self.parts.chain[-1]]
        return np.array(self.data.xaxis[first : first + count])

    def bending(self, axes: Floats) -> Bending:
        """How it bends and vibrates about its own first state."""
        natural = self._rigidity / self._length**2
        unit = _SMALL * natural
        self.unload()
        start, slopes = self.tip, self._slopes(axes)
        moment = unit * self._length
        self.load(np.zeros(3), moment * axes[2])
        self.rest()
        turned = self._slopes(axes) - slopes
        self.load(unit * axes[0], np.zeros(3))
        self.rest()
        tip_compliance = float((self.tip - start) @ axes[0]) / unit
        compliances = np.diff(turned[1:], prepend=0.0) / moment
        self.unload()
        s = np.append(0, np.cumsum(lengths(self.vertices)))
        arms = np.maximum(s[2:, None] - s[1:-1], 0)
        flexibility = (arms * compliances) @ arms.T
        dofs = self.model.body_dofadr[list(self.parts.chain)]
        masses = self._masses + self.model.dof_armature[dofs]
        squares, modes = _vibrations(flexibility, masses)
        rates = self.model.dof_damping[dofs] - 2 * self._omega * self._masses
        rayleigh = float(self.model.flex_damping[self.rod.flex])
        return Bending(
            compliances=compliances,
            tip_compliance=tip_compliance,
            squares=squares,
            damping=rayleigh * squares + rates @ modes**2,
            slowest_without_armature=float(_vibrations(flexibility, self._masses)[0][0]),
            stretch=self._stretch,
        )

    def _slopes(self, axes: Floats) -> Floats:
        """Slope angles of its edges [rad]."""
        edges = np.diff(self.vertices, axis=0)
        return np.asarray(np.arctan2(-edges @ axes[0], edges @ axes[1]))

    def _measure_stretch(self) -> float:
        """Strain of the edge that gives way most, over a pull on the tip; or less, if it creeps."""
        along = self.vertices[1] - self.vertices[0]
        natural = self._rigidity / self._length**2 * along / np.linalg.norm(along)
        stretch = 0.0
        for share in (_TINY, 1.0):
            self.set_back()
            before = lengths(self.vertices)
            self.load(share * natural, np.zeros(3))
            self._settles(_PULLED)
            after = lengths(self.vertices)
            stretch = float((after / before - 1).max()) / share
            if stretch > _TINY:
                break
        self.set_back()
        return stretch / float(np.linalg.norm(natural))

    def _stiffen_edges(self) -> None:
        """Take the stretch away, so that what bends shows by itself."""
        mine = self.model.eq_type == mujoco.mjtEq.mjEQ_FLEX
        mine &= self.model.eq_obj1id == self.rod.flex
        self.model.eq_solref[mine] = [2 * self.model.opt.timestep, 1]
        self.model.eq_solimp[mine] = [_HARD, _HARD, 1e-3, 0.5, 2]


def _vibrations(flexibility: Floats, masses: Floats) -> tuple[Floats, Floats]:
    """Squares of the frequencies, ascending, and their vibrations in columns, of unit mass."""
    root = np.sqrt(masses)
    inverse, shapes = np.linalg.eigh(root[:, None] * flexibility * root)
    order = slice(None, None, -1)
    return 1 / inverse[order], shapes[:, order] / root[:, None]
