"""Other projects' own published cases: what they print, what their engines give here, and ours."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from analytic.problem.beam import Beam
from analytic.space.checks.rod import integrate_rod
from compare.show.document import Document, Items, Table, Verdict, sections
from compare.verify import rods
from mujoco_models import Settings, load_tip

_Clamp: TypeAlias = Literal["naive", "second-order"]


@dataclass(frozen=True)
class PeerRow:
    peer: str
    case: str
    what: str
    published: str  # by the peer, with its own engine
    run: float | None  # the peer's own code on this machine
    trouble: str  # why there is none
    exact: float
    mujoco: float | None  # of the chain, with as many segments; none where it has no such model
    why: str = ""


def _tip(load: float, segments: int, clamp: _Clamp = "second-order") -> tuple[float, float]:
    return load_tip(load, Settings(segments=segments, clamp=clamp), Beam(radius=0.0))


def _run(distribution: str, number: Callable[[], float]) -> tuple[float | None, str]:
    """What a peer's code gives here; a line if it is missing or gives up."""
    try:
        return number(), ""
    except ImportError as error:
        missing = error.name or distribution
        return None, f"{missing} is not installed: pip install {distribution}"
    except Exception as error:  # whatever another's engine does
        return None, f"{distribution} failed: {' '.join(str(error).split())[:80]}"


def _cosseratbench_cantilever() -> list[PeerRow]:
    """Its error is relative to F L^3/(3 E I); github.com/jakeryderv/cosseratbench, 0.3.0."""
    case, segments = "cantilever", 20
    load = 7.5e-3 / (1e6 * math.pi / 4 * 0.02**4)
    bernoulli = load / 3

    def of(solver: str) -> float:
        bench, registry = map(import_module, ("cosseratbench.experiment", "cosseratbench.registry"))
        done = bench.run(registry.load_experiment(case), registry.load_solver(solver))
        if done.failure or done.missing:
            raise RuntimeError(done.failure or f"{solver} lacks {', '.join(done.missing)}")
        return float(done.metrics["tip_deflection_error"])

    exact = 1 - rods.tip_load(load)["w"] / bernoulli
    naive, ours = (1 - _tip(load, segments, clamp)[0] / bernoulli for clamp in get_args(_Clamp))
    why = f"the clamped link rigid: our chain so has {naive:.4g}; else {ours:.2g}"
    printed = {"mujoco": "0.0740595", "pyelastica": "0.073"}
    return [
        PeerRow("cosseratbench", case, f"error of the tip, {solver}", said,
                *_run("cosseratbench", partial(of, solver)), exact, ours, why)
        for solver, said in printed.items()
    ]  # fmt: skip


def _buckles(moment: float, tension: float) -> float:
    """Zero where a clamped rod under this twisting moment and tension has a bent neighbour."""
    slight, along = 1e-4, np.array([1.0, 0, 0])
    ends = []
    for push, turn in ((slight, 0), (0, slight)):
        clamp = np.array([-tension, push, 0]), np.array([moment, turn, 0])
        place, way, _ = integrate_rod(along, *clamp, 1.0)
        ends.append(np.array([place[-1], way[-1]]) @ [0, 1, 1j] / slight)
    # What happens in one direction happens in all, turned: so a complex number stands for both.
    return float((np.linalg.det(np.array(ends)) * np.exp(0.5j * moment)).imag)


def _cosseratbench_twist() -> list[PeerRow]:
    """Greenhill's moment M L/(E I) of a rod that is clamped, twisted and pulled."""
    rows = []
    for tension, between, published in ((1e-9, (8, 10), "2.861 pi"), (10.0, (9, 12), "")):

        def theirs(tension: float = tension) -> float:
            return float(import_module("cosseratbench.experiments.twist").critical_moment(tension))

        exact = float(brentq(_buckles, *between, args=(tension,), xtol=1e-10))
        about, why = "cosseratbench", "PyElastica reaches 0.978, 0.989, 0.991 of it"
        rows.append(
            PeerRow(about, "twist", f"critical moment at tension {tension:.2g}", published,
                    *_run(about, theirs), exact, None, f"a rod in space integrated; {why}")
        )  # fmt: skip
    return rows


def _cosseratbench_capstan() -> list[PeerRow]:
    """The overhang that holds, from dT/dphi = mu T + w R (cos phi + mu sin phi), by quadrature."""
    friction, short, radius = 0.3, 0.15, 0.051

    def gained(phi: float) -> float:
        own = math.cos(phi) + friction * math.sin(phi)
        return math.exp(friction * (math.pi - phi)) * own

    whole = quad(gained, 0, math.pi, epsabs=1e-14)[0]
    exact = math.exp(friction * math.pi) * short + radius * whole

    def theirs() -> float:
        return float(import_module("cosseratbench.experiments.capstan").holding_overhang(friction))

    return [
        PeerRow("cosseratbench", "capstan", "overhang that holds [m]", "0.48506",
                *_run("cosseratbench", theirs), exact, None,
                "published as 1.26 exp(mu pi) 0.15; no model here lies round a cylinder")
    ]  # fmt: skip


def _exudyn() -> list[PeerRow]:
    """Exudyn, Examples/ANCFcantileverTest.py: the tip's x by number of elements."""
    printed = {4: "-0.5074287154557922", 16: "-0.5085365799149556", 64: "-0.5085373030408489"}
    exact = rods.rectangle(2.0, 0.1, 0.1, 2.07e11, 0.0, [0.0, -1293750.0, 0.0])["x"]
    stretch = "the chain does not stretch, which makes 3.0e-4"
    return [
        PeerRow("Exudyn", "ANCFcantileverTest", f"x of the tip, {elements} elements [m]", said,
                *_run("exudyn", partial(_exudyn_tip, elements)), exact,
                -2 * _tip(3.0, elements)[1], stretch)
        for elements, said in printed.items()
    ]  # fmt: skip


def _exudyn_tip(elements: int) -> float:
    exudyn, items, beams = map(import_module, ("exudyn", "exudyn.itemInterface", "exudyn.beams"))
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    stiff = {"physicsBendingStiffness": 2.07e11 * 0.1**4 / 12, "physicsAxialStiffness": 2.07e9}
    cable = items.Cable2D(physicsMassPerLength=78.0, useReducedOrderIntegration=0, **stiff)
    made: Any = beams.GenerateStraightLineANCFCable2D(
        system, [0, 0, 0], [2, 0, 0], elements, cable,
        fixedConstraintsNode0=[1, 1, 0, 1], fixedConstraintsNode1=[0, 0, 0, 0],
    )  # fmt: skip
    marker = system.AddMarker(items.MarkerNodePosition(nodeNumber=made[0][-1]))
    system.AddLoad(items.Force(markerNumber=marker, loadVector=[0, -1293750.0, 0]))
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    settings.staticSolver.verboseMode = 0
    settings.staticSolver.newton.relativeTolerance = 1e-8
    settings.staticSolver.newton.absoluteTolerance = 1e-3
    system.SolveStatic(settings)
    return float(system.systemData.GetODE2Coordinates()[-4])


def _pyelastica() -> list[PeerRow]:
    """PyElastica, examples/CantileverTransversalLoadCase: the 45-degree bend of radius 1."""
    area, inertia, modulus = 1e-4, 1e-8 / 12, 1e9
    shear = modulus / 3  # as its helper sets it; its script says E/(1 + 0)
    stiff = [modulus * area, *[27 / 28 * shear * area] * 2]
    bending = [shear * 2 * inertia, modulus * inertia, modulus * inertia]
    exact = rods.bend(1.0, 45.0, 6.0, stiff, bending)["z"]
    other = rods.bend(1.0, 45.0, 6.0, stiff, [modulus * 2 * inertia, *bending[1:]])["z"]
    return [
        PeerRow("PyElastica", "CantileverTransversalLoadCase", "z of the tip, 400 elements [m]",
                "0.530065092", None, "PyElastica is not run: 2e6 steps", exact, None,
                f"1.5 % off the rod of its own stiffnesses; with the script's G {other:.4f}, 0.2 %")
    ]  # fmt: skip


def _newton() -> list[PeerRow]:
    """Newton, examples/vbd/example_cable_bend_stiffness.py: deflection times stiffness."""
    segments, size, force, joints = 16, 0.1, 0.5, (100.0, 300.0, 900.0)
    length = segments * size
    loads = [force * length**2 / (joint * size) for joint in joints]
    exact, ours = (
        [length * across * joint for across, joint in zip(found, joints, strict=True)]
        for found in (
            [rods.tip_load(load)["w"] for load in loads],
            [_tip(load, segments, "naive")[0] for load in loads],
        )
    )
    apart, chain = (max(abs(one / of[0] - 1) for one in of) for of in (exact, ours))
    return [
        PeerRow("Newton", "cable_bend_stiffness", "deflection times stiffness varies by",
                "< 0.10", None, "Newton is not run: newton.examples cable_bend_stiffness",
                apart, chain, "the large rotation alone; Newton's test allows fifty times as much")
    ]  # fmt: skip


CASES = (
    *(_cosseratbench_cantilever, _cosseratbench_twist, _cosseratbench_capstan),
    *(_exudyn, _pyelastica, _newton),
)
"""Each makes its rows. SimBenchmark's have rigid bodies alone: nothing of them applies to a rod."""


def summary(rows: Sequence[PeerRow]) -> tuple[Table, Items]:
    """One line a number of theirs, and what could not be run."""
    head = ("peer and number", "published", "theirs here", "exact", "our chain")
    lines = []
    for row in rows:
        numbers = ("" if x is None else f"{x:.7g}" for x in (row.run, row.exact, row.mujoco))
        lines.append((f"{row.peer}: {row.what}", row.published[:11], *numbers))
    table = Table("What peers publish of their own cases, and what is found here", head, lines)
    return table, Items(list(dict.fromkeys(filter(None, (row.trouble for row in rows)))))


def page(rows: Sequence[PeerRow]) -> Document:
    reasons = Items(list(dict.fromkeys(f"{row.peer}, {row.case}: {row.why}" for row in rows)))
    ran = sum(row.run is not None for row in rows)
    said = Verdict(ran == len(rows), f"{ran} of {len(rows)} numbers were made by their engines.")
    lead = "What other projects publish of their own test cases, beside what is computed here."
    parts = (
        ("numbers", "Number by number", summary(rows)),
        ("reasons", "Why they differ", [reasons]),
    )
    return Document("Peers' own cases", lead, said, sections(*parts))
