"""The constants of the way to rest, which should not show in a reading, and where one does."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Numerics:
    """Constants of the rest solver and of the walk, each with its reason.

    Measured on the catenary and the parabola, chain, N = 40, 60 stations, where nothing else is
    named. Readings are the same to 3e-9 of the largest one, and the snap-off to 4e-5 L, with any of
    them at the values that `tests/mujoco_models/sweep/test_rest.py` tries, but for `branch_turn`.
    """

    # Newton steps before a station is tried in smaller steps of the foot. Usually 2 to 4 suffice;
    # with fewer than a contact needs that changes its facet, steps are halved in vain.
    iterations: int = 25
    # Newton steps in a row without a better one, and the rest are not tried. From 6 to 25 nothing
    # changes on twenty sweeps at random, but for a third of their cost.
    in_vain: int = 8
    # Newton's method that comes nearer by less than this from step to step does not know the
    # stiffness at hand, and learns from its own steps. A tip that rounds a soft corner comes to
    # rest in half of the evaluations then; with 0.5 or 0.05 nothing changes on eight sweeps.
    slow: float = 0.2
    # It does so at less than this out of balance, over 1 + the load [EI/L]. Farther off, a beam
    # that lets go is kept from it: without a bound 2 of 50 sweeps did not snap off. At 1e-2 nothing
    # changes.
    learns: float = 1e-3
    # So much of each loaded contact's stiffness convexifies the quadratic model [EI/L^3], at most
    # half of it; the rest is the contact's compliance. Next to rest that is as good as any other
    # split, and Newton's method is quadratic. It matters on the way: at 1e3 the model is not convex
    # short of a fold already, the contour's curvature is left out of it, and to come to rest takes
    # twenty evaluations; above 1e6 forecasts take more steps (parabola, primitive).
    stiffening: float = 1e5
    # The same past facets, whose curvature is not known well. At 1e2 it takes half as many
    # evaluations again, at 1e5 a twentieth fewer; the snap-off moves by less than 4e-5 L.
    stiffening_of_facets: float = 1e3
    # Tolerances out of balance below which rounding of depths may be what is left.
    nearly: float = 1e3
    # The most steps of a forecast. Usually 2 or 3 suffice; where there is no state at rest near the
    # last one, more are in vain.
    forecasts: int = 5
    # A forecast ends with a step that turns all links by less than this [rad]: what is left is of
    # the order of its square.
    foreseen: float = 1e-6
    # Of any link in one Newton step [rad]. At 0.1 it takes an eighth more evaluations, at 1 a
    # fifteenth fewer, to the same states.
    largest_turn: float = 0.3
    # The most contacts that a Newton step sees, the nearest ones: along the flank of a needle
    # thousands of beads are within MuJoCo's reach, and those that come to be loaded are seen in the
    # next step. Twice as many as are loaded, if these are more: a beam that lies on a flat facet
    # rests on hundreds, and without all of them no step ends at rest.
    at_once: int = 200
    # What rounding makes of a facet's normal [rad]. Above a facet's turn, every corner would be
    # taken for flat, and Newton's method would not settle on it.
    same_normal: float = 1e-9
    # Beads beyond the loaded ones that take part in collisions. With fewer,
    # the load moves on to a bead that does not collide, and steps are repeated; the state at rest
    # is checked against all beads.
    ahead: int = 4
    margin: int = 2  # and those that must do so
    # A link that turns farther than this from one state at rest to the next has left the branch
    # [rad]. Too large, and a jump to another branch passes for a step; too small, and every step of
    # the foot is halved. At 0.7 nothing changes; at 0.1 one station of the catenary is another
    # state at rest, 2e-3 of a reading away.
    branch_turn: float = 0.35
    # Newton's method on its way from there is followed no further than this [rad]: it hardly ever
    # comes back.
    left_turn: float = 0.7
    # A contact whose slope angle jumps by more than this from one state at rest to the next has
    # left the branch [rad]. A corner that passes from bead to bead turns the force by up to 0.7.
    largest_shift: float = 1.0
    # The same where the obstacle has sharp corners. At 1.0 a tip goes on to rest on the next facet
    # while it is still held on its own, at one station in 1,600 of random polygons.
    facet_shift: float = 0.1
    # A contact at a slope angle nearer than this to that of a facet is on the facet [rad].
    same_facet: float = 1e-3
    # A step in which a curved vibrissa may come to touch [L, rad]: one of 0.045 L pressed a tip
    # that points back to another state.
    landing_step: float = 2e-3
    # A snap-off is confirmed if the beam is carried off with the foot so far beyond the last state
    # at rest [L]: the most by which a wrong stiffness of the solver can displace it.
    confirm_step: float = 1e-4
    # Beads beyond the loaded ones that take part in collisions during a descent, beside one of
    # every link. From 8 to 32 nothing changes.
    reach: int = 16
    # Of any link in a step of a descent, about [rad]. From 1e-3 to 1e-2 beams 1e-4 L before their
    # fold are held, and beams as far beyond are let go; at 1e-3 it takes ten times as long.
    gentle_turn: float = 1e-2
    # What the steps of a descent begin with, in units of each joint's stiffness; it changes until
    # they are as gentle as that.
    inertia: float = 100.0
    # The most steps of a descent. 60 are usual; past many corners it takes more.
    descent_steps: int = 1000
    # So many steps of a descent in a row without a load, and the beam is free.
    unloaded_steps: int = 20
    fallen: float = 1e-10  # A step of a descent that is shorter than this has come to rest [rad]
    # The most evaluations that a station may take; it is unsettled then. Snap-off takes 500.
    budget: int = 5000
    # The budget halves after such a station, down to this, and doubles again after one that
    # settles: a sweep that has lost its way ends in bounded time.
    least_budget: int = 400
    # A jump that a step of the foot as small as this does not prevent is a snap-off [L]. It is how
    # well snap-off is located; 1e-6 moves it by less than 1e-4.
    smallest_step: float = 1e-5
    # A load that vanishes at once was let go, one below this just faded [EI/L^2]. At 0, a load that
    # fades away at the end of reach would be taken for a snap-off.
    load_held: float = 1e-2
