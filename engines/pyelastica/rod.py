"""PyElastica's rod, stepped and damped by its own modules; see `engines.stepping.Stepper`.

The first element is held by its middle, so that the rod begins half an element before the clamp.
The foot stands and the object moves, which is the same at rest. Masses are ours to choose, as
nothing of them shows at rest: the lightest that a step of 1 allows. Explicit steps must follow the
stiffest swing, shear and stretch of one element, which is 2 sqrt(S)/(3.5 h) times as fast as the
slowest, bending.
"""

from typing import Any

import elastica
import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.case import Case
from engines.agreement import State, hinges
from engines.pyelastica.contact import Arcs, push, touch

STIFFNESS = 4e4
"""S: of shear and stretch [EI/L^2]. A load of 20 stretches the rod by 5e-4."""
_CONTACT = 0.25  # of a contact, by that of an element, S/h
_TURNS = 0.05  # how much slower a step is for elements that turn: these are the heavier then
_MARGIN = 1.02  # of masses: loads make the fastest swing a little faster
_FREE, _PINNED = 3.516, 15.418  # sqrt(EI/L^4/mass by length); slowest swings of a cantilever


class _Simulator(
    elastica.BaseSystemCollection,  # type: ignore[misc]
    elastica.Constraints,  # type: ignore[misc]
    elastica.Forcing,  # type: ignore[misc]
    elastica.Damping,  # type: ignore[misc]
):
    """With the modules that are used."""


class ElasticaRod:
    """A rod, an object beside it, and the state that both are in."""

    def __init__(self, case: Case, elements: int) -> None:
        self.layout = hinges(case, elements - 1, last=1.0)
        self._length = length = 1 / (elements - 0.5)
        self._radius, self._arcs = case.radius, Arcs.of(case)
        self._stiffness = _CONTACT * STIFFNESS / length
        self._foot_x = float(case.foot_x[0]) / case.beam.length
        self._forces, self._places = np.zeros((2, 2 * elements + 1)), np.zeros(elements)
        mass = _MARGIN * (STIFFNESS * (1 + _TURNS) / length + self._stiffness / 2)
        inertia = _MARGIN * (STIFFNESS * length * (1 + 1 / _TURNS) / 4 + 1 / length)
        self._rod = _rod(elements, length, mass, inertia)
        pace = np.sqrt(length / mass)
        self.period = int(2 * np.pi / (_PINNED * pace))
        self._simulator = _Simulator()
        self._simulator.append(self._rod)
        self._simulator.constrain(self._rod).using(
            elastica.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,)
        )
        self._simulator.add_forcing_to(self._rod).using(_Push, self)
        self._simulator.dampen(self._rod).using(_Damp, slowest=_FREE * pace, fastest=_PINNED * pace)
        self._simulator.finalize()
        self._stepper = elastica.PositionVerlet()

    def touch(self) -> int:
        """Where the object pushes now, and on how many elements and nodes."""
        return touch(
            self._rod.position_collection,
            self._foot_x,
            self._arcs,
            self._stiffness,
            self._forces,
            self._places,
        )

    def push(self, outer: Floats) -> None:
        """Add to the forces on nodes what the object does."""
        if self.touch():
            push(outer, self._forces, self._places)

    def step(self, foot_x: float) -> None:
        """One of PyElastica's."""
        self._foot_x = foot_x
        self._stepper.step(self._simulator, 0.0, 1.0)

    def look(self) -> State:
        """By nodes, and by stress and couple in the first element, carried to the foot."""
        rod = self._rod
        for system in self._simulator.final_systems():
            system.compute_internal_forces_and_torques(0.0)
        nodes = rod.position_collection[:2].T
        self.touch()
        forces = self._forces.T
        felt = forces.any(axis=1)
        size = np.hypot(*forces[felt].T)[:, None]
        axis = np.vstack([nodes[:-1] + self._places[:, None] * np.diff(nodes, axis=0), nodes])
        # Directors are in rows; a rod of PyElastica's gets thinner where it is longer.
        fx, fy, _ = rod.director_collection[:, :, 0].T @ rod.internal_stress[:, 0]
        fx, fy = fx / rod.dilatation[0], fy / rod.dilatation[0]
        thinner = rod.voronoi_dilatation**3
        moment = rod.director_collection[:, 2, 0] @ rod.internal_couple[:, 0] / thinner[0]
        x, y = nodes[1]
        along = rod.director_collection[2, :2]
        turns = np.diff(np.unwrap(np.arctan2(-along[0], along[1]))) / thinner
        return State(
            nodes[1:].copy(),
            -np.array([fx, fy, moment + x * fy - y * fx]),
            axis[felt] - self._radius * forces[felt] / size,
            forces[felt].copy(),
            turns,
        )

    def _changing(self) -> list[Floats]:
        rod = self._rod
        return [
            rod.position_collection,
            rod.director_collection,
            rod.velocity_collection,
            rod.omega_collection,
        ]

    def keep(self) -> list[Floats]:
        """Places, directions and their rates."""
        return [part.copy() for part in self._changing()]

    def go_back(self, kept: list[Floats]) -> None:
        """To the same."""
        for part, before in zip(self._changing(), kept, strict=True):
            part[:] = before


def _rod(elements: int, length: float, mass: float, inertia: float) -> Any:  # noqa: ANN401
    """An upright one whose rigidity is 1, with these masses of nodes and inertias of elements."""
    radius = 0.01  # not the vibrissa's: PyElastica computes rigidity and masses from it
    rod = elastica.CosseratRod.straight_rod(
        elements,
        start=np.array([0.0, -length / 2, 0.0]),
        direction=np.array([0.0, 1.0, 0.0]),
        normal=np.array([0.0, 0.0, 1.0]),
        base_length=elements * length,
        base_radius=radius,
        density=1.0,
        youngs_modulus=4 / (np.pi * radius**4),
    )
    axes = np.arange(3)
    rod.shear_matrix[axes, axes] = STIFFNESS
    rod.mass[:] = mass
    rod.mass_second_moment_of_inertia[axes, axes] = inertia
    rod.inv_mass_second_moment_of_inertia[axes, axes] = 1 / inertia
    return rod


class _Push(elastica.NoForces):  # type: ignore[misc]
    """The object, as PyElastica asks for forces."""

    def __init__(self, rod: ElasticaRod) -> None:
        self._rod = rod

    def apply_forces(self, system: Any, time: float = 0.0) -> None:  # noqa: ANN401
        """Those of now."""
        self._rod.push(system.external_forces)


class _Damp(elastica.DamperBase):  # type: ignore[misc]
    """Damping that is critical for whatever swing is left, by its stiffness and mass.

    Their ratio is that of changes of acceleration and place: dynamic relaxation (Papadrakakis,
    Comput. Methods Appl. Mech. Eng. 25, 1981).
    """

    def __init__(self, slowest: float, fastest: float, **system: Any) -> None:  # noqa: ANN401
        super().__init__(**system)
        self._bounds, self._every, self._steps = (slowest, fastest), 25, 0
        self._kept, self._places, self._pulls = np.exp(-2 * fastest), np.zeros(0), np.zeros(0)

    def dampen_rates(self, system: Any, time: float) -> None:  # noqa: ANN401
        """After every step."""
        if self._steps % self._every == 0:
            places = system.position_collection.ravel().copy()
            pulls = system.acceleration_collection.ravel().copy()
            if self._steps:
                moved = places - self._places
                stiff, heavy = -moved @ (pulls - self._pulls), moved @ moved
                if heavy > 0:
                    swing = np.sqrt(max(stiff / heavy, 0.0))
                    self._kept = np.exp(-2 * np.clip(swing, *self._bounds))
            self._places, self._pulls = places, pulls
        self._steps += 1
        system.velocity_collection *= self._kept
        system.omega_collection *= self._kept
