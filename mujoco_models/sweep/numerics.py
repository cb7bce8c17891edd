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
    largest_shift : float
        A contact whose slope angle jumps by more than this from one state at rest to the next has
        left the branch [rad]. A corner that passes from bead to bead turns the force by up to 0.7.
    refinements : int
        Newton steps with MuJoCo's own derivative, where MuJoCo's motion says that the beam is held
        and `iterations` did not find where.
    difference : float
        The turn that the derivative is taken by [rad]: short of the depth of a contact over the
        beam's length, 1e-7, and far above rounding.
    confirm_step : float
        A snap-off is confirmed if the beam is carried off with the foot so far beyond the last
        state at rest [L]. It is the most by which a wrong stiffness of the solver can displace it.
        Shorter, the descent takes longer, with the inverse root.
    reach : int
        Beads beyond the loaded ones that take part in collisions during a descent, beside one of
        every link. From 6 to 32 nothing changes.
    descent_steps : int
        Steps of a descent before `refine` tries to find where the beam rests.
    inertia, far_inertia : float
        What shortens the steps of a descent, in units of each joint's stiffness, until the beam has
        left the branch and after. With 10 instead of 100 it lets go too early. MuJoCo's own steps
        have the same limit: those of 1e-3, which is an inertia of 100, hold the catenary's chain
        3e-4 L before its fold; those of 2e-3 release it 3e-3 L before.
    unloaded_steps : int
        So many steps of a descent in a row without a load, and the beam is free.
    fallen : float
        A step of a descent that is shorter than this has come to rest [rad].
    budget : int
        The most evaluations that a station may take, see `BeamModel.effort`; it is unsettled
        then. A station next to snap-off takes up to 3,000.
    least_budget : int
        The budget halves after such a station, down to this, and doubles again after one that
        settles: a sweep that has lost its way ends in bounded time.
    smallest_step : float
        A jump that a step of the foot as small as this does not prevent is a snap-off [L]. It is
        how well snap-off is located; 1e-6 moves it by less than 1e-4.
    load_held : float
        On the far side of the object, where the foot moves away from it, a load below this may fade
        from one state to the next [EI/L^2].
    """

    iterations: int = 25
    stiffening: float = 1e3
    largest_turn: float = 0.3
    same_normal: float = 1e-9
    ahead: int = 4
    margin: int = 2
    branch_turn: float = 0.35
    largest_shift: float = 1.0
    refinements: int = 8
    difference: float = 1e-8
    confirm_step: float = 1e-3
    reach: int = 8
    descent_steps: int = 2000
    inertia: float = 100.0
    far_inertia: float = 4.0
    unloaded_steps: int = 20
    fallen: float = 1e-10
    budget: int = 30_000
    least_budget: int = 400
    smallest_step: float = 1e-5
    load_held: float = 1e-2
