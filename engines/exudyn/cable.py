"""Exudyn's planar ANCF cable, clamped upright at the origin, held at one point of it.

Cubic elements in Exudyn's static solver. What holds the cable is a joint of Exudyn's at a point in
space: a revolute joint at the cable's tip, or a sliding joint, through which the cable slips
without friction, so that the joint's force is normal to the cable. The foot stays and the point
moves, which is the same. Dimensionless: L = EI = 1.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import NamedTuple

import exudyn
import numpy as np
from exudyn import itemInterface as item  # noqa: N813  # the library's own name

from analytic.numerics.arrays import Floats
from mujoco_models.beams.vibrissa import Vibrissa

AXIAL_STIFFNESS = 1e6  # EI/L^2; a load of 10 stretches the cable by 1e-5
_SLIPPED = 1e-9  # L; a joint that slipped no farther in a solution is where its force acts
_NO_FORCE = 1e-12  # EI/L^2; one that has no direction
_REPEATS = 20  # three are usual
_FORCE = exudyn.OutputVariableType.Force
_COORDINATES = exudyn.OutputVariableType.Coordinates
_TORQUE = exudyn.OutputVariableType.TorqueLocal
_START = exudyn.ConfigurationType.Initial
_NOW = exudyn.ConfigurationType.Current


class LostError(Exception):
    """Exudyn's solver found no cable at rest."""


class Hold(NamedTuple):
    """How the cable is held, by which of the two joints."""

    slides: bool  # by the sliding joint, otherwise at its tip
    arc_length: float  # where along the cable [L]
    point: Floats  # shape (2,); Where in space, seen from the foot [L]
    # Shape (2,); Unit vector at right angles to the force there: the sliding cable's tangent.
    along: Floats


class Cable:
    """A cable of `elements` elements, and a point where it is held."""

    def __init__(self, elements: int, vibrissa: Vibrissa) -> None:
        tip, along = vibrissa.at(np.array(1.0)), vibrissa.rest.at(np.array(1.0))[2]
        self.held = Hold(False, 1.0, tip, np.array([np.cos(along), np.sin(along)]))
        self.beyond = False
        self._container = exudyn.SystemContainer()
        self._system = self._container.AddSystem()
        self._length = 1 / elements
        cables = self._add_cables(np.linspace(0, 1, elements + 1), vibrissa)
        self._add_joints(cables)
        self._add_clamp(cables[0], vibrissa.clamp_compliance)
        self._system.Assemble()
        self._settings = _settings()

    def _add_cables(self, edges: Floats, vibrissa: Vibrissa) -> list[int]:
        """The elements, upright; they start from the shape of the vibrissa at rest."""
        mbs = self._system
        softness, _ = vibrissa.bending(edges)
        turn = vibrissa.turn(edges)
        rest = np.column_stack([vibrissa.at(edges), -np.sin(turn), np.cos(turn)])
        self._upright = np.zeros_like(rest)
        self._upright[:, 1], self._upright[:, 3] = edges, 1.0
        self._nodes = [
            mbs.AddNode(
                item.NodePoint2DSlope1(
                    referenceCoordinates=upright.tolist(),
                    initialCoordinates=(place - upright).tolist(),
                )
            )
            for place, upright in zip(rest, self._upright, strict=True)
        ]
        return [
            mbs.AddObject(
                item.ObjectANCFCable2D(
                    length=self._length,
                    massPerLength=1,  # irrelevant at rest
                    bendingStiffness=1 / soft,
                    referenceCurvature=natural,
                    axialStiffness=AXIAL_STIFFNESS,
                    nodeNumbers=list(ends),
                )
            )
            for ends, soft, natural in zip(
                pairwise(self._nodes),
                softness.tolist(),
                (np.diff(turn) / self._length).tolist(),
                strict=True,
            )
        ]

    def _add_joints(self, cables: list[int]) -> None:
        mbs, count = self._system, len(cables)
        self._point = mbs.AddObject(item.ObjectGround(referencePosition=[*self.held.point, 0]))
        self._at_point = mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=self._point))
        self._spans = [
            mbs.AddMarker(item.MarkerBodyCable2DCoordinates(bodyNumber=i)) for i in cables
        ]
        self._sliding = mbs.AddObject(
            item.ObjectJointSliding2D(  # the first object with multipliers: fx, fy and the slip
                markerNumbers=[self._at_point, self._spans[-1]],
                slidingMarkerNumbers=self._spans,
                slidingMarkerOffsets=(self._length * np.arange(count)).tolist(),
                nodeNumber=mbs.AddNode(
                    item.NodeGenericData(
                        initialCoordinates=[count - 1, 1.0], numberOfDataCoordinates=2
                    )
                ),
                activeConnector=False,
            )
        )
        tip = mbs.AddMarker(item.MarkerNodePosition(nodeNumber=self._nodes[-1]))
        self._revolute = mbs.AddObject(
            item.ObjectJointRevolute2D(markerNumbers=[self._at_point, tip])
        )

    def _add_clamp(self, cable: int, compliance: float) -> None:
        """What holds the foot: x, y and the slope, or x, y and a spring."""
        mbs = self._system
        ground = mbs.AddNode(item.NodePointGround())
        fixed = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
        # The slope vector's x is the third coordinate; its virtual work is that of a moment about
        # -z, as is Exudyn's torque of the spring.
        self._clamp = [
            mbs.AddObject(
                item.ObjectConnectorCoordinate(
                    markerNumbers=[
                        fixed,
                        mbs.AddMarker(
                            item.MarkerNodeCoordinate(nodeNumber=self._nodes[0], coordinate=i)
                        ),
                    ]
                )
            )
            for i in range(3 if compliance == 0 else 2)
        ]
        self._spring = None
        if compliance > 0:
            world = mbs.AddObject(item.ObjectGround())
            ends = [mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=i)) for i in (world, cable)]
            self._spring = mbs.AddObject(
                item.ObjectConnectorTorsionalSpringDamper(
                    markerNumbers=ends, stiffness=1 / compliance, offset=np.pi / 2
                )
            )

    def state(self) -> tuple[Hold, list[Floats]]:
        return self.held, [np.array(part) for part in self._system.systemData.GetSystemState()]

    def go_back(self, state: tuple[Hold, list[Floats]]) -> None:
        held, solver = state
        self._system.systemData.SetSystemState(solver, configuration=_START)
        self._hold(held)

    def hold_tip(self) -> None:
        self._hold(self.held._replace(slides=False, arc_length=1.0))

    def let_slide(self, arc_length: float, point: Floats) -> None:
        self._hold(self.held._replace(slides=True, arc_length=arc_length, point=point))

    def _hold(self, held: Hold) -> None:
        self.held, self.beyond = held, False
        self._system.SetObjectParameter(self._revolute, "activeConnector", not held.slides)
        self._system.SetObjectParameter(self._sliding, "activeConnector", held.slides)

    def solve(self, point: Floats) -> Floats:
        """Bring the cable to rest.

        Exudyn's sliding joint lets its force act where the cable was in it when the solution began,
        and a second time by how far it has slipped since. So the solution is repeated from there
        until it slips no more.
        """
        mbs = self._system
        mbs.SetObjectParameter(self._point, "referencePosition", [*point.tolist(), 0.0])
        guess = float((point - self.held.point) @ self.held.along)
        slips, share = self._solve_once(guess), 1.0
        for _ in range(_REPEATS):
            if abs(slips) < _SLIPPED or self.beyond:
                break
            step = slips / share
            before, slips = slips, self._solve_once(step)
            share = float(np.clip((before - slips) / step, 0.5, 2.0))  # by secants
        else:
            raise LostError
        forces = [float(np.ravel(mbs.GetObjectOutput(i, _FORCE))[0]) for i in self._clamp]
        if self._spring is not None:
            forces.append(float(mbs.GetObjectOutput(self._spring, _TORQUE)))
        x, y, turn = forces
        along = np.array([y, -x]) / max(np.hypot(x, y), _NO_FORCE)
        self.held = self.held._replace(point=point, along=along)
        return np.array([x, y, -turn])

    def _solve_once(self, slipped: float) -> float:
        """By how far the cable slips in its joint, from where it would be if it slipped so far."""
        mbs, held = self._system, self.held
        if held.slides:
            s = float(np.clip(held.arc_length + slipped, 0.0, 1.0))
            element = min(int(s / self._length), len(self._spans) - 1)
            span = [self._at_point, self._spans[element]]
            mbs.SetObjectParameter(self._sliding, "markerNumbers", span)
            mbs.AssembleLTGLists()  # or its force stays with the coordinates of the element before
            for when in (_START, _NOW):
                mbs.systemData.SetDataCoordinates([element, s], when)
            self.held = held._replace(arc_length=s)
        try:
            with _quiet():
                mbs.SolveStatic(self._settings, updateInitialValues=True)
        except exudyn.SolverError as error:
            raise LostError from error
        if not held.slides:
            return 0.0
        on = float(mbs.systemData.GetAECoordinates()[2])
        self.beyond = s == 1 and on > 0
        return on

    def ends(self) -> tuple[Floats, Floats]:
        """Positions and tangents of the nodes, of the state that `solve` found."""
        coordinates = np.array([self._system.GetNodeOutput(i, _COORDINATES) for i in self._nodes])
        both = coordinates + self._upright
        return both[:, :2], both[:, 2:]


@contextmanager
def _quiet() -> Iterator[None]:
    """Not a line for each step that fails: it is halved."""
    before, exudyn.config.printToConsole = exudyn.config.printToConsole, False
    try:
        yield
    finally:
        exudyn.config.printToConsole = before


def _settings() -> exudyn.SimulationSettings:
    settings = exudyn.SimulationSettings()
    settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
    settings.solution.file.write = False
    static = settings.staticSolver
    static.numberOfLoadSteps = 1
    static.adaptiveStep = False
    static.verboseMode = 0
    static.newton.residualMode = 1  # stops by the step: rounding of EA limits the residual
    static.newton.relativeTolerance = 1e-8
    static.newton.absoluteTolerance = 1e-8
    static.newton.maxIterations = 30
    return settings
