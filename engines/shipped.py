"""The engines that come along: twins of MuJoCo's chain, and models of their own.

The library of an engine is imported when it sweeps.
"""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from importlib import import_module
from importlib.metadata import version
from typing import Any, ClassVar

from threadpoolctl import threadpool_limits

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from engines.engine import Role
from engines.stations import sweep_stations
from engines.stepping import sweep_stepping
from mujoco_models.settings import Settings

_LET_GO = 1e-6  # L; PyElastica's rest takes milliseconds, so a snap-off is located finely


@dataclass(frozen=True, kw_only=True)
class _Shipped:
    """See `engines.engine.Engine`."""

    name: str
    requires: str
    tuned: str
    libraries: dict[str, str]  # distributions by the names that provenance has for them
    model: str  # module and class that import them

    @property
    def engine(self) -> str:
        return ", ".join(f"{name} {version(of)}" for name, of in self.libraries.items())

    def load(self) -> Any:  # noqa: ANN401  # another class each
        module, _, name = self.model.partition(":")
        return getattr(import_module(module), name)


@dataclass(frozen=True, kw_only=True)
class _Twin(_Shipped):
    """Sweeps by the rest solver of MuJoCo's chain, on its own balance of moments."""

    role: ClassVar[Role] = "twin"

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> Readings:
        from engines.twin import sweep_twin  # imports MuJoCo

        return sweep_twin(case, settings, self.name, self.engine, self.load, advance)


@dataclass(frozen=True, kw_only=True)
class _OtherModel(_Shipped):
    """Sweeps from rest to rest of its own."""

    role: ClassVar[Role] = "other model"
    source: str
    swept: Callable[..., Readings]
    check: Callable[[str, Case], None]
    obstacle: str | None = None  # what it touches; None of those that settings name

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> Readings:
        self.check(self.name, case)
        made_of: Settings | int = settings if self.obstacle is None else settings.segments
        chosen = {"elements": settings.segments, "obstacle": self.obstacle}
        about = {
            "engine": f"{self.engine}, vibrissa-testbed {version('vibrissa-testbed')}",
            "settings": asdict(settings) if self.obstacle is None else chosen,
        }
        with threadpool_limits(1):
            return self.swept(
                case, lambda left: self.load()(left, made_of), self.source, about, advance
            )


def _plain(name: str, case: Case) -> None:
    case.require_plain(name)
    if case.radius == 0:
        raise InputError("beam.radius", 0, f"positive for {name}", "it cannot collide a line")


def _uniform(name: str, case: Case) -> None:
    beam, cannot = case.beam, f"{name} cannot take it into account"
    if case.friction != 0:
        raise InputError("friction", case.friction, f"0: {cannot}", "leave it out")
    if beam.tip_radius not in (None, beam.radius):
        allowed = f"{beam.radius:g}: {cannot}"
        raise InputError("beam.tip_radius", beam.tip_radius, allowed, "leave it out")


DRAKE = _Twin(
    name="drake",
    requires="drake>=1.40,<2",
    tuned="nothing: joints, springs, spheres, contact stiffness and rest solver are those of "
    "MuJoCo's chain",
    libraries={"Drake": "drake"},
    model="engines.drake.chain:DrakeLinkage",
)
PINOCCHIO = _Twin(
    name="pinocchio",
    requires="pin>=4.1,<5",
    tuned="coal's tolerance, from 1e-6 to 1e-12; joints, springs, spheres, contact stiffness and "
    "rest solver are those of MuJoCo's chain",
    libraries={"Pinocchio": "pin", "coal": "coal"},
    model="engines.pinocchio.chain:PinocchioLinkage",
)
DART = _OtherModel(
    name="dart",
    requires="dartpy>=6.20,<7",
    tuned="no sleep and no friction; springs as torques of every step; inertia and damping for a "
    "quick rest, which shows in no reading",
    libraries={"DART": "dartpy"},
    model="engines.dart.chain:DartChain",
    source="dart chain",
    swept=sweep_stepping,
    check=_plain,
)
EXUDYN = _OtherModel(
    name="exudyn",
    requires="exudyn>=1.13,<2",
    tuned="axial stiffness 1e6 EI/L^2; no penalty: a joint of Exudyn's without friction, moved "
    "along the contour until its force is normal to it",
    libraries={"Exudyn": "exudyn"},
    model="engines.exudyn.contact:CableOnContour",
    source="exudyn ANCF cable",
    swept=sweep_stations,
    check=_uniform,
    obstacle="the contour, by a joint on it",
)
PYELASTICA = _OtherModel(
    name="pyelastica",
    requires="pyelastica>=1.0,<2",
    tuned="the rod begins half an element before the clamp; a contact of our own, 1e9 EI/L^4; "
    "shear and stretch 1e5 EI/L^2; rest by Newton's method, instead of steps in time",
    libraries={"PyElastica": "pyelastica"},
    model="engines.pyelastica.rod:ElasticaRod",
    source="pyelastica rod",
    swept=partial(sweep_stepping, smallest=_LET_GO),
    check=_plain,
    obstacle="the contour, by a contact of our own",
)
