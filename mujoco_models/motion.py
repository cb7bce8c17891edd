"""How a sweep in motion is driven and stepped."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from pydantic import ConfigDict, StrictFloat

from analytic.problem.errors import InputError
from mujoco_models.allowed import Limits, check_number, check_numbers, check_word

IntegratorKind: TypeAlias = Literal["discrete", "implicitfast", "implicit", "euler", "rk4"]
SolverKind: TypeAlias = Literal["newton", "cg", "pgs"]
ConeKind: TypeAlias = Literal["pyramidal", "elliptic"]
INTEGRATORS, SOLVERS, CONES = map(get_args, (IntegratorKind, SolverKind, ConeKind))

# A stiffness [EI/L^3] times the squared time step [T1]. Measured on the catenary at 0.1 L/T1, steps
# of 0.005 to 0.04 T1 and N of 20 and 40: 1 and 4 leave at most 2 of 60 stations chattering, 16 as
# many and three times the error. N = 80 on a mesh takes 1: 3e-3 instead of 8e-3. Integrators that
# are explicit in the contact diverge at 4, whatever the armature.
_STIFFNESS, _STIFFNESS_EXPLICIT = 4.0, 1.0
_LIMITS: Limits = {
    "speed": (1e-6, 10, "in L/T1; 0.004 is a slow whisk"),
    "timestep": (1e-7, 0.1, "in T1, the slowest period; 0.02 is usual"),
    "damping_ratio": (0.0, 100, "0.05 is usual"),
    "armature": (0.0, 1e6, "explicit integrators need about 1"),
    "solimp": (0.001, 0.9999, "0.9 is usual"),
    "impratio": (1e-3, 1e6, "1 is MuJoCo's, 100 holds better"),
    "ramp": (0.0, 1e3, "in T1; 1 is usual"),
    "average": (0.0, 1, "1 is all the way"),
    "friction": (0.0, 10, "leave it out for the case's"),
    "cutoff": (1e-3, 1e9, "in 1/T1; leave it out for no filter"),
    "contact_stiffness": (1e3, 1e9, "1e4 is usual"),
}


@dataclass(frozen=True)
class Motion:
    """A sweep in motion.

    The unit of time is the first period T1 of the free vibrissa, with density uniform along it:
    T1 = 1.787 L^2 sqrt(mass per length/EI). No other property of its mass matters but for the
    rotary inertia of its sections, which is of the order of (radius/L)^2.

    Parameters
    ----------
    speed : float
        Of the foot, or where the clamp turns, one L from it [L/T1].
    timestep : float
        Of MuJoCo [T1].
    integrator : str
        MuJoCo's: ``"discrete"`` is implicit in springs, dampers and contacts; all others are
        explicit in springs, and stable below about 1/(2 N^2) T1 unless there is an armature.
    damping_ratio : float
        Of the first free vibration, by dampers in proportion to the stiffness.
    armature : float
        Inertia added to every joint, over what the joint's spring makes critical in a step:
        stiffness times `timestep` squared. Explicit integrators need about 1; it slows all but the
        slow vibrations of the beam.
    contact_stiffness : float, optional
        Force over penetration of a contact at rest, at every link [EI/L^3]; critically damped. If
        it is not given, 4/`timestep`^2: with chains of 20 to 40 segments that is about the stiffest
        contact that does not chatter at 0.1 L/T1, at steps from 0.005 to 0.04 T1; slower sweeps
        take more. Integrators other than ``"discrete"`` diverge there; for them it is a quarter of
        that, and chatters.
    solref : tuple of float, optional
        MuJoCo's time constant [T1] and damping ratio of a contact, in the place of a stiffness.
    solimp : float
        MuJoCo's impedance d of a contact, the same at all depths.
    solver : str
        MuJoCo's solver of the constraints.
    cone : str
        Of friction; matters with a friction coefficient only.
    friction : float, optional
        Coulomb's coefficient between vibrissa and object; if it is not given, the case's.
    impratio : float
        MuJoCo's ratio of frictional to normal impedance, of elliptic cones. MuJoCo's friction
        yields: below a sliding speed in inverse proportion to this, it is a drag in proportion to
        the speed.
    ramp : float
        Time in which the foot reaches its speed, evenly [T1].
    average : float
        Share of the way between two stations over which the readings are averaged, half before the
        station and half behind it; 0 takes the last step before it.
    cutoff : float, optional
        Of the sensor's low-pass filter of first order [1/T1].

    Raises
    ------
    InputError
        If a number is out of its range.
    """

    __pydantic_config__ = ConfigDict(extra="forbid")  # a misspelt key in a case file is an error

    speed: StrictFloat = 0.01
    timestep: StrictFloat = 0.02
    integrator: IntegratorKind = "discrete"
    damping_ratio: StrictFloat = 0.05
    armature: StrictFloat = 0.0
    contact_stiffness: StrictFloat | None = None
    solref: tuple[StrictFloat, StrictFloat] | None = None
    solimp: StrictFloat = 0.9
    solver: SolverKind = "newton"
    cone: ConeKind = "pyramidal"
    friction: StrictFloat | None = None
    impratio: StrictFloat = 1.0
    ramp: StrictFloat = 1.0
    average: StrictFloat = 1.0
    cutoff: StrictFloat | None = None

    def __post_init__(self) -> None:
        for name, allowed in (("integrator", INTEGRATORS), ("solver", SOLVERS), ("cone", CONES)):
            check_word(f"motion.{name}", getattr(self, name), allowed)
        check_numbers("motion", self, _LIMITS)
        if self.solref is not None:
            if self.contact_stiffness is not None:
                raise InputError(
                    "motion.contact_stiffness",
                    self.contact_stiffness,
                    "left out where solref is given",
                    "leave one of them out",
                )
            if not (isinstance(self.solref, tuple | list) and len(self.solref) == 2):
                raise InputError("motion.solref", self.solref, "two numbers", "as (0.1, 1.0)")
            check_number(
                "motion.solref[0]", self.solref[0], 1e-6, 1e3, "MuJoCo's time constant in T1"
            )
            check_number(
                "motion.solref[1]", self.solref[1], 1e-3, 1e3, "MuJoCo's damping ratio; 1 is usual"
            )

    @property
    def stiffness(self) -> float:
        """Force over penetration of a contact, unless `solref` is given [EI/L^3]."""
        if self.contact_stiffness is not None:
            return self.contact_stiffness
        implicit = self.integrator == "discrete"
        return (_STIFFNESS if implicit else _STIFFNESS_EXPLICIT) / self.timestep**2
