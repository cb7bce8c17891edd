"""Synthetic experiments: the closed form with its inputs off, as an independent program has it."""

from dataclasses import replace

import numpy as np

from analytic import (
    CLAMP_READINGS,
    SENSED,
    Beam,
    Case,
    Readings,
    Sweep,
    circle,
    named_case,
    solve_sweep,
)
from compare import Input, Uncertainties

CASES = {
    **{name: named_case(name) for name in ("catenary", "parabola", "two-circles", "tip-only")},
    "circle": Case(profile=circle(1.0, (0.0, 0.4)), name="circle"),
}


def off(case: Case, errors: dict[str, float]) -> Readings:
    """What a sensor reads, without noise, over the stations that it believes to be at."""
    beam = case.beam
    beam = Beam(
        beam.length + errors.get("length", 0.0),
        beam.flexural_rigidity + errors.get("flexural_rigidity", 0.0),
        beam.radius + errors.get("radius", 0.0),
    )
    shift = errors.get("foot_x", 0.0)
    first, last = case.foot_x[[0, -1]] + shift
    varied = replace(
        case,
        beam=beam,
        profile=case.profile.raised(errors.get("height", 0.0)),
        friction=abs(errors.get("friction", 0.0)),
        clamp_angle=errors.get("clamp_angle", 0.0),
        sweep=Sweep(2),
    )
    first = max(first, varied.foot_x[0])  # a sweep starts clear of the object
    exact = solve_sweep(replace(varied, sweep=Sweep(case.sweep.stations, first, last)))
    read = {n: exact.values(n) * (1 + errors.get(f"gain_{n}", 0.0)) for n in CLAMP_READINGS}
    table = exact.table.assign(foot_x=exact.values("foot_x") - shift, **read)
    table = table[(table["phase"] != "free").to_numpy() & exact.trusted]
    return Readings(table[list(SENSED)].reset_index(drop=True), case.beam, "measured")


def stated(case: Case, exact: Readings, rng: np.random.Generator) -> Uncertainties:
    """Uncertainties as they may be: from 1e-4 to a few per cent, some of them uniform."""
    largest = {"flexural_rigidity": -1.5, "gain_moment_z": -1.5, "length": -2.3, "foot_x": -2.3}
    largest |= {"radius": -3.0, "height": -3.0, "friction": -1.7}
    names = [*largest][:6] if rng.uniform() < 2 / 3 else [*largest]
    sizes = {name: 10 ** rng.uniform(-4.3, largest[name]) for name in names}
    noise = {n: 10 ** rng.uniform(-4, -2.5) * np.abs(exact.values(n)).max() for n in CLAMP_READINGS}
    return Uncertainties({name: Input(size) for name, size in sizes.items()}, noise)


def measured(case: Case, known: Uncertainties, rng: np.random.Generator) -> Readings:
    """An experiment whose errors are drawn from what is stated."""
    errors = {name: one.standard * rng.standard_normal() for name, one in known.inputs.items()}
    found = off(case, errors)
    noisy = {
        name: found.values(name) + size * rng.standard_normal(len(found.table))
        for name, size in known.noise.items()
    }
    return replace(found, table=found.table.assign(**noisy))
