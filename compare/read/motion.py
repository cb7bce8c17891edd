"""The ``[motion]`` table of a case file: natural units, or quantities with units."""

import math
from dataclasses import fields
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias, get_type_hints

from pydantic import Field, PlainValidator, create_model

from analytic import Beam, InputError
from compare.read.quantities import PLAIN, Dimension, InSI, Table
from compare.read.toml import KeyPlace
from mujoco_models.motion import Motion

_FIRST_ROOT = 1.8751040687119611  # of cos(x) cosh(x) = -1: the first vibration of a cantilever
_OF_A_MODEL = ("speed", "ramp", "average", "cutoff", "contact_stiffness")

Speed = Annotated[float, PlainValidator(Dimension("m/s")), PLAIN]
Time = Annotated[float, PlainValidator(Dimension("s")), PLAIN]
Frequency = Annotated[float, PlainValidator(Dimension("1/s")), PLAIN]
Density = Annotated[float, PlainValidator(Dimension("kg/m^3")), PLAIN]
Solref = Annotated[tuple[Time, float], Field(strict=False)]
_POSITIVE = Field(gt=0, allow_inf_nan=False)


class _MotionTable(Table):
    """How the foot moves and MuJoCo steps; see `mujoco_models.Motion`.

    Plain numbers are in natural units, L and the first period T1 of the free vibrissa. Texts with a
    unit need to know T1 in seconds: by ``period`` itself, or by the ``density`` of a round and
    solid vibrissa, whose dimensions then have units, too.
    """

    period: Annotated[Time, _POSITIVE] | None = None
    density: Annotated[Density, _POSITIVE] | None = None

    def build(self, beam: Beam) -> Motion:
        period = self._period(beam)
        numbers = {name: x for name, x in self if name not in _MotionTable.model_fields}
        speed, solref = numbers["speed"], numbers["solref"]
        if isinstance(speed, InSI) and not beam.si and period:
            allowed = "a number, in L/T1, where the vibrissa's length has no unit"
            remedy = "give the length with a unit, or the speed without"
            raise InputError("motion.speed", f"{float(speed):g} m/s", allowed, remedy)
        numbers["speed"] = _over(speed, period and beam.length / period)
        for name in ("timestep", "ramp"):
            numbers[name] = _over(numbers[name], period)
        numbers["cutoff"] = _over(numbers["cutoff"], period and 1 / period)
        numbers["solref"] = solref and (_over(solref[0], period), solref[1])
        return Motion(**numbers)

    def of_a_model(self, beam: Beam, place: KeyPlace) -> Motion:
        """The motion of a user's own model, which brings most of it with it."""
        for name in type(self).model_fields:
            if name in self.model_fields_set and name not in _OF_A_MODEL:
                allowed = f"left to the model; beside a [model] there are {', '.join(_OF_A_MODEL)}"
                raise InputError(place(["motion", name]), "stated", allowed, "take it out")
        return self.build(beam)

    def _period(self, beam: Beam) -> float | None:
        """T1 [s], if it can be known."""
        if self.density is None:
            return self.period
        if self.period is not None:
            allowed, remedy = "left out where the period is given", "take one"
        elif not beam.si:
            allowed = "left out where the vibrissa's dimensions have no units"
            remedy = "give the dimensions with units, or the period"
        else:
            return first_period(beam, self.density)
        raise InputError("motion.density", self.density, allowed, remedy)


if TYPE_CHECKING:
    MotionTable: TypeAlias = _MotionTable
else:
    _WITH_UNITS = {"speed": Speed, "timestep": Time, "ramp": Time, "cutoff": Frequency | None,
                   "solref": Solref | None}  # fmt: skip
    _KEYS: dict[str, Any] = get_type_hints(Motion, include_extras=True) | _WITH_UNITS
    MotionTable = create_model(
        "MotionTable",
        __base__=_MotionTable,
        **{field.name: (_KEYS[field.name], field.default) for field in fields(Motion)},
    )


def first_period(beam: Beam, density: float) -> float:
    """First period of the free vibrissa, T1 = 2 pi (L/1.8751)^2 sqrt(rho A/EI).

    That is Euler's and Bernoulli's cantilever: S. S. Rao, Mechanical Vibrations, chapter 8.
    """
    mass = density * math.pi * beam.radius**2
    slowness = math.sqrt(mass / beam.base_rigidity)
    return 2 * math.pi * (beam.length / _FIRST_ROOT) ** 2 * slowness


def _over(value: float | None, unit: float | None) -> float | None:
    """A number in natural units: a plain one is, and one in SI is divided by the unit."""
    if not isinstance(value, InSI):
        return None if value is None else float(value)
    if unit is None:
        allowed = "with the period T1 of the free vibrissa, or its density, too"
        remedy = 'add period = "28 ms" or density = "7850 kg/m^3", or give numbers in L and T1'
        raise InputError("motion", "with quantities that have units", allowed, remedy)
    return float(value) / unit
