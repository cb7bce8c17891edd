"""What the sources on contact and whiskers ask for, by the solvers of sweeps."""

import math

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipj, ellipkinc

from analytic import Beam, catenary, circle, solve_contact
from analytic.checks.integration import integrate_span
from analytic.solver.elastica import frame, tangent_span
from analytic.space import FootPath, SpatialCase, solve_space, sphere
from compare.verify.rods import Parts

_THIN = Beam(radius=0.0)
_PEG = 0.01  # radius [L]
_SLIGHT = 1e-4  # slope at which a peg is felt [rad]


def level() -> Parts:
    """Contact where the contour is level: Bernoulli's rectangular elastica."""
    height = 0.35
    state = solve_contact(catenary(0.5, height - 1), [0.0], _THIN).iloc[0]
    moment = height * float(state["moment_z"])
    length = float(state["contact_arc_length"]) / height
    return {"A": length * moment / 2, "B": moment / 2, "2B": moment}


def _amplitude(angle: float) -> float:
    """The paper's H_B."""
    z = min(1.0, math.sqrt(2) * math.sin(math.pi / 4 - angle / 2))
    return float(ellipkinc(math.asin(z), 0.5))


def tangential(degrees: float) -> Parts:
    """Phase B by the paper's (20), (21) and (26), its elliptic functions integrated numerically."""
    alpha, contour = math.radians(degrees), catenary(0.5, -0.8)
    state = solve_contact(contour, [alpha], _THIN).iloc[0]
    force = float(np.hypot(state["force_x"], state["force_y"]))
    first, last = map(_amplitude, (math.pi / 2 - alpha, 0.0))

    def climb(tau: float) -> float:
        sn = ellipj(tau, 0.5)[0]
        return math.sin(alpha - math.pi / 2 + 2 * math.acos(math.sqrt(0.5) * float(sn)))

    whole = quad(climb, first, last, epsabs=1e-13, epsrel=1e-13)[0]
    height = float(state["contact_y"])
    return {
        "f": force,
        "s1": float(state["contact_arc_length"]),
        "M^2": float(state["moment_z"]) ** 2,
        "(20)": (whole / height) ** 2,
        "(21)": height * (last - first) / whole,
        "(26)": 2 * float(state["force_y"]),
    }


def sliding_sleeve() -> Parts:
    """Along the clamp, in space: where a vibrissa slides freely past a sphere, and M^2/(2 EI)."""
    body = sphere(1.0, centre=(0, 1.4, 0))
    path = FootPath([[1.3, 0.3], [0.2, 0.3]], stations=12)
    readings = solve_space(SpatialCase(Beam(), body=body, path=path))
    station = readings.table[readings.table["phase"] == "tangent"].iloc[-1]
    moment = [float(station[f"moment_{axis}"]) for axis in "xyz"]
    return {"along": float(station["force_y"]), "M^2/2EI": float(np.dot(moment, moment)) / 2}


def peg(distance: float, taper: float) -> Parts:
    """A vibrissa pressed slightly on a peg: stiffness a^3 k/(3 EI), and the distance it shows."""
    alpha = math.pi / 2 - _SLIGHT
    lowest = 1.0, distance + _PEG * math.cos(alpha) - _PEG
    beam = Beam(radius=0.0, flexural_rigidity=lambda s: (1 - (1 - taper) * s) ** 4)
    state = solve_contact(circle(_PEG, lowest=lowest), [alpha], beam).iloc[0]
    deflection = float(state["contact_x"] - state["foot_x"])
    whole = 1 / (1 - taper) if taper < 1 else math.inf  # length to the cone's point
    return {
        "k": -float(state["force_x"]) / deflection * distance**3 / 3,
        "(L - a)/L": 1 - distance / whole,
        "3 EI theta/M": 3 * (deflection / distance) / float(state["moment_z"]),
        "a": distance,
    }


def first_touch(coefficient: float, reach: float, radius: float, length: float) -> Parts:
    """A whisker curved as y = g x^2 that touches a pole at x: the pole's axis."""

    def arc(x: float) -> float:
        slope = 2 * coefficient * x
        return (slope * math.hypot(1, slope) + math.asinh(slope)) / (4 * coefficient)

    def curvature(s: np.ndarray) -> np.ndarray:
        x = [brentq(lambda x, s=s: arc(x) - s, 0, length, xtol=1e-15) for s in np.ravel(s)]
        bent = 2 * coefficient / (1 + (2 * coefficient * np.array(x)) ** 2) ** 1.5
        return np.asarray(-bent.reshape(np.shape(s)))

    beam = Beam(length=length, radius=0.0, natural_curvature=curvature)
    none = np.zeros(1)
    end = integrate_span(
        *(none, none, none, np.array([arc(reach) / length])),
        natural=lambda s: length * beam.curvature_at(length * s),
    )
    # From an upright clamp the whisker leans to the right; the source's lies along x.
    x, y = length * float(end.y[0]), length * float(end.x[0])
    slope = math.pi / 2 - float(end.phi[0])
    centre = {"x": x + radius * math.sin(slope), "y": y - radius * math.cos(slope)}
    return {**centre, "distance": math.hypot(x, y), "slope": slope}


def pressed(s: float, force: float, rigidity: float) -> Parts:
    """A rod pressed by a force normal to it at arc length s: force along the clamp, and moment."""
    load = force * s**2 / rigidity
    alpha = brentq(
        lambda a: float(tangent_span(np.array(a)).q) ** 2 - load, -1.5, 1.5707, xtol=1e-15
    )
    loaded = tangent_span(np.array(alpha))
    up, across = frame(loaded, np.array(alpha))
    return {
        "along": -force * math.cos(alpha),
        "moment": force * s * float(loaded.C / loaded.q),
        "x": s * float(up / loaded.q),
        "y": s * float(across / loaded.q),
    }


def elastica3d(s: float, force: float, rigidity: float, node: float) -> Parts:
    """How far Elastica3D's chain ends from the exact contact: links between nodes, all turned.

    Its first joint stands at the base and turns by a whole link's share of the moment.
    """
    links = round(s / node)
    size = s / links
    place, across = np.array([size, 0.0]), np.array([0.0, 1.0])  # seen from the last link
    for _ in range(links):
        lever = place[0] * across[1] - place[1] * across[0]
        turn = size * force * lever / rigidity
        rotation = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
        place, across = rotation @ place + [size, 0.0], rotation @ across
    exact = pressed(s, force, rigidity)
    return {"mm": 1e3 * math.hypot(place[0] - size - exact["x"], place[1] - exact["y"])}
