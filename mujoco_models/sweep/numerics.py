"""The constants of the way to rest: none of them may show in a reading."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Numerics:
    """Constants of the rest solver and of the walk, each with its reason.

    What happens when one is off was tried on the catenary and the parabola (chain, N = 40).

    Parameters
    ----------
    iterations : int
        Newton steps before a station is tried in smaller steps of the foot. Usually 2
        to 4 suffice; with fewer than a contact needs that changes its facet, steps are halved in
        vain.
    stiffening : float
        Loaded contacts convexify the quadratic model by this much [EI/L^3]; their slack is zero at
        rest, and so is the effect there. It matters on the way: at 1e2 the quadratic model leaves
        the branch before the fold, and the catenary snaps off 1.9e-3 L early with every station
        "ok". From 3e2 to 1e6 the snap-off moves by less than 7e-5 L.
    largest_turn : float
        Of any link in one Newton step [rad]. At 1 the solver jumps to another state at rest, 1.8e-3
        away, which is "ok" by itself; from 0.1 to 0.5 nothing changes.
    same_normal : float
        What rounding makes of a facet's normal [rad]. Above a facet's turn, every corner would be
        taken for flat, and Newton's method would not settle on it.
    ahead, margin : int
        Beads beyond the loaded ones that take part in collisions, and that must do so. With fewer,
        the load moves on to a bead that does not collide, and steps are repeated; the state at rest
        is checked against all beads.
    branch_turn : float
        A link that turns farther than this from one state at rest to the next has left the branch
        [rad]. Too large, and a jump to another branch passes for a step; too small, and every
        step of the foot is halved. From 0.1 to 0.7 nothing changes.
    fall_reach : int
        Beads beyond the loaded ones that take part in collisions during a fall, beside one of every
        link. From 8 to 32 nothing changes.
    fall_steps : int
        The most steps of a fall. What has not come to rest by then is relaxed from where it is.
    fall_inertia, far_inertia : float
        What shortens the steps of a fall, in units of each joint's stiffness, until it has left the
        branch and after. With 10 instead of 100 the vibrissa lets go too early; after it has left,
        0 takes 12 to 15 % fewer evaluations and gives readings equal to 1e-10.
    fallen : float
        A step of a fall that is shorter than this has come to rest [rad]. From 1e-11 to 1e-9
        nothing changes.
    smallest_step : float
        A jump that a step of the foot as small as this does not prevent is a snap-off [L]. It is
        how well snap-off is located; 1e-6 moves it by less than 1e-4.
    load_held : float
        A load that vanishes at once was let go, one below this just faded [EI/L^2]. At 0, a
        load that fades away at the end of reach would be taken for a snap-off.
    """

    iterations: int = 25
    stiffening: float = 1e3
    largest_turn: float = 0.3
    same_normal: float = 1e-9
    ahead: int = 4
    margin: int = 2
    branch_turn: float = 0.35
    fall_reach: int = 16
    fall_steps: int = 5000
    fall_inertia: float = 100.0
    far_inertia: float = 4.0
    fallen: float = 1e-10
    smallest_step: float = 1e-5
    load_held: float = 1e-2
