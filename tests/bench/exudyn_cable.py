"""A circle past Exudyn's static ANCF cable: a reference outside MuJoCo, to time and compare with.

Two-dimensional cubic ANCF elements in Exudyn's static solver; its own contact of cable and circle,
frictionless, by penalty; the clamp's action is the constraint forces that hold the first node. The
foot stays and the circle moves, which is the same. Where Newton's method fails, the step of the
circle is halved. With ten times the penalty 20 elements err by 2e-4 instead of 3e-4, but 40
elements leave the branch unnoticed.
"""

from itertools import pairwise

import exudyn
import numpy as np
from exudyn import itemInterface as item  # noqa: N813  # the library's own name

from analytic import SENSED, Readings

PENALTY = 1e6  # EI/L^3, of each contact segment
AXIAL_STIFFNESS = 1e6  # EI/L^2; a load of 10 stretches the cable by 1e-5
CONTACT_SEGMENTS = 4  # straight pieces of an element that the circle feels
_SMALLEST_STEP = 1e-4  # L


class ExudynCable:
    """A cable of `elements` elements, clamped upright at the origin, and a circle.

    Dimensionless: L = EI = 1.
    """

    def __init__(self, elements: int, radius: float) -> None:
        exudyn.SetWriteToConsole(False)  # a step that fails is halved
        self._container = exudyn.SystemContainer()
        self.system = mbs = self._container.AddSystem()
        nodes = [
            mbs.AddNode(item.NodePoint2DSlope1(referenceCoordinates=[0, i / elements, 0, 1]))
            for i in range(elements + 1)
        ]
        self._circle = mbs.AddObject(item.ObjectGround(referencePosition=[9, 0, 0]))
        circle = mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=self._circle))
        for ends in pairwise(nodes):
            cable = mbs.AddObject(
                item.ObjectANCFCable2D(
                    length=1 / elements,
                    massPerLength=1,  # irrelevant at rest
                    bendingStiffness=1,
                    axialStiffness=AXIAL_STIFFNESS,
                    nodeNumbers=list(ends),
                )
            )
            shape = mbs.AddMarker(
                item.MarkerBodyCable2DShape(bodyNumber=cable, numberOfSegments=CONTACT_SEGMENTS)
            )
            gaps = mbs.AddNode(
                item.NodeGenericData(
                    initialCoordinates=[1.0] * CONTACT_SEGMENTS,
                    numberOfDataCoordinates=CONTACT_SEGMENTS,
                )
            )
            mbs.AddObject(
                item.ObjectContactCircleCable2D(
                    markerNumbers=[circle, shape],
                    nodeNumber=gaps,
                    numberOfContactSegments=CONTACT_SEGMENTS,
                    contactStiffness=PENALTY,
                    circleRadius=radius,
                )
            )
        fixed = mbs.AddMarker(
            item.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(item.NodePointGround()), coordinate=0)
        )
        # x, y, and the slope vector's x: its virtual work is that of a moment about -z.
        self._clamp = [
            mbs.AddObject(
                item.ObjectConnectorCoordinate(
                    markerNumbers=[
                        fixed,
                        mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=i)),
                    ]
                )
            )
            for i in range(3)
        ]
        mbs.Assemble()
        self._settings = _settings()

    def move_circle(self, x: float, y: float, before: float) -> np.ndarray | None:
        """Bring the circle's centre from `before` to `x`, and the cable to rest.

        Returns
        -------
        array or None
            force_x, force_y and moment_z of the clamp; None if it does not come to rest.
        """
        at, step = before, x - before
        while at != x:
            trial = x if abs(step) >= abs(x - at) else at + step
            if self._solve(trial, y):
                at, step = trial, 2 * step
            else:
                step = (trial - at) / 2
                if abs(step) < _SMALLEST_STEP:
                    return None
        force = exudyn.OutputVariableType.Force
        held = [float(np.ravel(self.system.GetObjectOutput(i, force))[0]) for i in self._clamp]
        return np.array([held[0], held[1], -held[2]])

    def _solve(self, x: float, y: float) -> bool:
        mbs = self.system
        mbs.SetObjectParameter(self._circle, "referencePosition", [x, y, 0.0])
        try:
            mbs.SolveStatic(self._settings, updateInitialValues=True)
        except exudyn.SolverError:
            return False  # and the initial values stay
        return True


def sweep(elements: int, exact: Readings, radius: float, centre: tuple[float, float]) -> Readings:
    """The stations of `exact`, all in contact, to the first at which the cable does not rest."""
    cable = ExudynCable(elements, radius)
    foot_x = exact.values("foot_x")
    rows = []
    before = centre[0] - foot_x[0] + 0.05
    for x in foot_x:
        held = cable.move_circle(centre[0] - x, centre[1], before)
        if held is None:
            break
        rows.append([x, *held])
        before = centre[0] - x
    table = exact.table.iloc[: len(rows)][list(SENSED)].copy()
    table[list(SENSED)] = rows
    return Readings(table, exact.beam, f"Exudyn, {elements} elements")


def _settings() -> exudyn.SimulationSettings:
    settings = exudyn.SimulationSettings()
    settings.linearSolverType = exudyn.LinearSolverType.EigenSparse
    settings.solution.file.write = False
    static = settings.staticSolver
    static.numberOfLoadSteps = 1
    static.adaptiveStep = False
    static.verboseMode = 0
    static.newton.newtonResidualMode = 1  # stops by the step: rounding of EA limits the residual
    static.newton.relativeTolerance = 1e-8
    static.newton.absoluteTolerance = 1e-8
    static.newton.maxIterations = 30
    return settings
