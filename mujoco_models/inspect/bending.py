"""How a vibrissa on its held foot bends and vibrates; plain numbers, in the model's units."""

from dataclasses import dataclass

from analytic.problem.arrays import Floats


@dataclass(frozen=True, eq=False)
class Bending:
    """Small displacements about a state at rest."""

    # Shape (n_joints,); Turn over moment of each joint, about the axis across the sweep [1/(force
    # length)].
    compliances: Floats
    # Displacement of the tip over a force on it, both along the sweep [length/force].
    tip_compliance: float
    # Shape (n,); Squares of the angular frequencies of free vibration, ascending [1/time^2].
    squares: Floats
    # Shape (n,); Rates at which dampers slow these vibrations: twice the damping ratio times the
    # angular frequency [1/time].
    damping: Floats
    # The first of the squares without the joints' own inertia [1/time^2].
    slowest_without_armature: float
    # Strain of its edges over a pull along them; 0 for what cannot stretch [1/force].
    stretch: float = 0.0
