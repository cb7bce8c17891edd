"""Exudyn's planar ANCF cable, clamped upright at the origin, and a circle that it touches.

Cubic elements in Exudyn's static solver, its own frictionless contact of cable and circle, by
penalty. The foot stays and the circle moves, which is the same. Dimensionless: L = EI = 1.
"""

from itertools import pairwise

import exudyn
import numpy as np
from exudyn import itemInterface as item  # noqa: N813  # the library's own name

from analytic.problem.arrays import Floats

AXIAL_STIFFNESS = 1e6  # EI/L^2; a load of 10 stretches the cable by 1e-5
CONTACT_SEGMENTS = 8  # straight pieces of an element that the circle feels
_AWAY = (9.0, 0.0)  # L


class Cable:
    """A cable of `elements` elements, and a circle.

    Parameters
    ----------
    elements : int
        How many.
    penalty : float
        Force over penetration of each piece that touches [EI/L^3].
    """

    def __init__(self, elements: int, penalty: float) -> None:
        exudyn.config.printToConsole = False  # a step that fails is halved
        self._container = exudyn.SystemContainer()
        self._system = mbs = self._container.AddSystem()
        self._length = 1 / elements
        self._nodes = [
            mbs.AddNode(item.NodePoint2DSlope1(referenceCoordinates=[0, i / elements, 0, 1]))
            for i in range(elements + 1)
        ]
        self._circle = mbs.AddObject(item.ObjectGround(referencePosition=[*_AWAY, 0]))
        circle = mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=self._circle))
        self._contacts = []
        for ends in pairwise(self._nodes):
            cable = mbs.AddObject(
                item.ObjectANCFCable2D(
                    length=self._length,
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
            contact = item.ObjectContactCircleCable2D(
                markerNumbers=[circle, shape],
                nodeNumber=gaps,
                numberOfContactSegments=CONTACT_SEGMENTS,
                contactStiffness=penalty,
                circleRadius=1.0,
            )
            self._contacts.append(mbs.AddObject(contact))
        ground = mbs.AddNode(item.NodePointGround())
        fixed = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
        # x, y, and the slope vector's x: its virtual work is that of a moment about -z.
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
            for i in range(3)
        ]
        mbs.Assemble()
        self._settings = _settings()

    def state(self) -> list[Floats]:
        """What the solver starts from: coordinates, multipliers and open or closed contacts.

        Returns
        -------
        list of array, any shape
            For `go_back`.
        """
        return [np.array(part) for part in self._system.systemData.GetSystemState()]

    def go_back(self, state: list[Floats]) -> None:
        """Start from there.

        Parameters
        ----------
        state : list of array, any shape
            Of `state`.
        """
        self._system.systemData.SetSystemState(
            state, configuration=exudyn.ConfigurationType.Initial
        )

    def solve(self, centre: Floats, radius: float) -> Floats | None:
        """Bring the cable to rest.

        Parameters
        ----------
        centre : array, shape (2,)
            Of the circle, seen from the foot [L].
        radius : float
            Of it; the cable is a line [L].

        Returns
        -------
        array, shape (3,), or None
            force_x, force_y and moment_z of the clamp; None if it does not come to rest.
        """
        mbs = self._system
        mbs.SetObjectParameter(self._circle, "referencePosition", [*centre.tolist(), 0.0])
        for contact in self._contacts:
            mbs.SetObjectParameter(contact, "circleRadius", radius)
        try:
            mbs.SolveStatic(self._settings, updateInitialValues=True)
        except exudyn.SolverError:
            return None
        force = exudyn.OutputVariableType.Force
        x, y, slope = (float(np.ravel(mbs.GetObjectOutput(i, force))[0]) for i in self._clamp)
        return np.array([x, y, -slope])

    def ends(self) -> tuple[Floats, Floats]:
        """Positions and tangents of the nodes, of the state that `solve` found.

        Returns
        -------
        positions, tangents : array, shape (n_elements + 1, 2)
            Seen from the foot [L]; derivatives by arc length.
        """
        coordinates = np.array([self._system.GetNodeOutput(i, _COORDINATES) for i in self._nodes])
        rest = np.zeros_like(coordinates)
        rest[:, 1], rest[:, 3] = self._length * np.arange(len(self._nodes)), 1.0
        both = coordinates + rest
        return both[:, :2], both[:, 2:]


_COORDINATES = exudyn.OutputVariableType.Coordinates


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
