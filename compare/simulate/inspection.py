"""A model that was measured, beside what it should be: figures and remarks."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from analytic import Beam
from compare.simulate.links import order_in_links
from compare.simulate.remark import RIGIDITY, Remark
from compare.simulate.remarks import remarks
from compare.simulate.rigidity import (
    as_intended,
    at_its_tip,
    clamp_stiffness,
    counted_twice,
    elastica_error,
    smooth_rigidity,
)
from mujoco_models import OwnModel, inspect_model
from mujoco_models.inspect.measured import MeasuredBeam

_WIDTH = 22


@dataclass(frozen=True)
class Inspection:
    found: MeasuredBeam  # as `mujoco_models.inspect_model` measured it
    stated: Beam | None = None  # what it should be, in the model's units

    @cached_property
    def remarks(self) -> tuple[Remark, ...]:
        """What there is to say, the faults first."""
        return remarks(self.found, self.stated)

    @property
    def faults(self) -> tuple[Remark, ...]:
        """The remarks that are no mere notes."""
        return tuple(remark for remark in self.remarks if remark.kind == "fault")

    @property
    def sound(self) -> bool:
        return not self.faults

    def lines(self) -> Iterator[str]:
        found = self.found
        faults = len(self.faults)
        verdict = "sound" if self.sound else f"{faults} fault{'s' if faults > 1 else ''}"
        yield f"{found.model or 'model'}, in its own units: {verdict}"
        for name, text in self._figures():
            yield f"  {name:{_WIDTH}}{text}"
        for remark in self.remarks:
            yield f"{remark}"

    def _figures(self) -> Iterator[tuple[str, str]]:
        found = self.found
        length, period = found.length, found.period
        radii = [geom.radius for geom in found.geoms]
        yield "vibrissa", f"{len(found.joints)} joints, {len(found.geoms)} geoms on {found.foot!r}"
        yield "length", f"{length:.6g}"
        yield "radius", " to ".join(f"{x:.4g}" for x in dict.fromkeys((radii[0], radii[-1])))
        modulus = 4 * smooth_rigidity(found, np.zeros(1))[0] / (np.pi * radii[0] ** 4)
        means = f"as if round and solid, of E = {modulus:.2g}"
        yield "EI of its joints", f"{as_intended(found):.6g}, {means}"
        curved = as_intended(found) / at_its_tip(found)  # the tip of an arc moves by less
        yield "EI of its tip", f"{found.tip_rigidity * curved:.6g} under a small force"
        error = elastica_error(found)
        if np.isfinite(error):
            yield "large bending", f"tip within {error:.1e} L of the exact cantilever"
        order = order_in_links(found)
        if order is not None:
            own = f"tip off by {order.error:.1e} L with its joints' EI"
            finer = ", ".join(
                f"by {error:.1e} L with {times * order.links:.0f}"
                for times, error in ((2, order.error_of_twice), (4, order.error_of_fourfold))
            )
            alone = "" if 0.9 < order.order < 2.1 else f", as its ends suit {order.links:.0f} alone"
            yield (
                "order in its links",
                f"{order.order:.1f}{alone}: {own}; links laid out alike: {finer}",
            )
        stiffness = clamp_stiffness(found)
        yield (
            "clamp",
            "rigid" if np.isinf(stiffness) else f"turns, by a spring of {stiffness:.3g} EI/L",
        )
        yield "natural curvature", f"{round(found.natural_curvature * length, 9) + 0.0:.3g}/L"
        twice = counted_twice(found)
        by_density = f"; of a mass by density {twice:.1%} is in two capsules at once"
        yield "mass", f"{found.mass:.4g}{by_density if twice > RIGIDITY else ''}"
        yield "first period T1", f"{period:.4g}; damping ratio {found.damping_ratio:.3g}"
        fraction = found.timestep / period
        yield "time step", f"{found.timestep:g} ({fraction:.2g} T1), {found.integrator}"
        yield "foot", found.drive or "nothing moves it"

    def to_dict(self) -> dict[str, Any]:
        error, stiffness = elastica_error(self.found), clamp_stiffness(self.found)
        order = order_in_links(self.found)
        return {
            "sound": self.sound,
            "remarks": [asdict(remark) for remark in self.remarks],
            "flexural_rigidity": as_intended(self.found),
            "clamp_stiffness": stiffness if np.isfinite(stiffness) else None,
            "elastica_error": error if np.isfinite(error) else None,
            "order_in_links": None if order is None else asdict(order),
            "measured": self.found.to_dict(),
        }


def measured_beam(model: OwnModel) -> MeasuredBeam:
    names = {name: getattr(model, name) for name in ("foot", "force", "torque", "geoms", "site")}
    return inspect_model(model.file, **names)
