"""What the sources on rods ask for: elastica under dead loads, and rods that stretch and shear."""

import math
from typing import TypeAlias

import numpy as np
from scipy.optimize import brentq, root
from scipy.spatial.transform import Rotation
from scipy.special import ellipe, ellipk

from analytic.numerics.arrays import Floats
from analytic.solver.elastica import frame, span
from analytic.space.checks.rod import Cantilever

Parts: TypeAlias = dict[str, float]
"""Numbers by name."""

_ANGLES = 1e-9, math.pi / 2 - 1e-9  # that a dead tip load turns a cantilever by
_HARDLY = 1e-7  # how far a buckled column bends


def _closed_form(turned: float, alpha: float) -> tuple[float, float, float]:
    """Load and place of the tip of a vibrissa, by the functions that its sweeps use."""
    loaded = span(np.array(turned), np.array(alpha))
    up, across = frame(loaded, np.array(alpha))
    return float(loaded.q) ** 2, float(up / loaded.q), float(across / loaded.q)


def tip_load(load: float) -> Parts:
    """A cantilever under a dead load across it: contact with an upright side."""
    upright = math.pi / 2
    turned = brentq(lambda w: _closed_form(w, upright)[0] - load, *_ANGLES, xtol=1e-15, rtol=1e-14)
    _, up, across = _closed_form(turned, upright)
    return {"w": across, "u": 1 - up, "theta": turned}


def column(degrees: float) -> Parts:
    """A column after buckling, by its tip's rotation, and the textbook's complete integrals."""
    turned = math.radians(degrees)
    load, up, across = _closed_form(turned, 0.0)
    m = math.sin(turned / 2) ** 2
    whole = float(ellipk(m))
    return {
        "P": load / (math.pi / 2) ** 2,
        "x": up,
        "y": across,
        "textbook P": (2 * whole / math.pi) ** 2,
        "textbook x": 2 * float(ellipe(m)) / whole - 1,
        "textbook y": 2 * math.sqrt(m) / whole,
    }


def self_buckling() -> Parts:
    """The weight under which a standing rod leans: w L^3/EI."""
    bent = np.array([0, 0, _HARDLY])

    def missed(weight: float) -> float:
        rod = Cantilever(1.0, np.zeros(3), np.ones(3), weight=np.array([-weight, 0, 0]))
        return float(rod.march(bent)[1][2]) / _HARDLY

    return {"w": float(brentq(missed, 6, 9, xtol=1e-9))}


def rectangle(
    length: float,
    width: float,
    height: float,
    modulus: float,
    poisson: float,
    force: list[float],
    moment: tuple[float, ...] = (0, 0, 0),
    shear: float = math.inf,
    shear_z: float | None = None,
    torsion: float | None = None,
    twisted: float = 1.0,
    elements: int | None = None,
) -> Parts:
    """A cantilever of rectangular section: `height` along y, `width` along z.

    Shear correction factors (infinite: no shear), and that of the polar moment for torsion; else
    the rectangle's own torsion constant (Timoshenko and Goodier, Theory of elasticity), times
    `twisted`. The rod itself, or `elements` of it.
    """
    area, sliding = width * height, modulus / (2 * (1 + poisson))
    about_y, about_z = height * width**3 / 12, width * height**3 / 12
    if torsion is None:
        thin, wide = sorted((width, height))
        odd = np.arange(1, 60, 2)
        tails = np.tanh(odd * math.pi * wide / (2 * thin)) / odd**5
        whole = 1 - 192 * thin / (math.pi**5 * wide) * float(tails.sum())
        twist = twisted * wide * thin**3 / 3 * whole
    else:
        twist = torsion * (about_y + about_z)
    stiff = np.array([modulus, sliding * shear, sliding * (shear_z or shear)]) * area
    bending = np.array([sliding * twist, modulus * about_y, modulus * about_z])
    loads = np.array(force, float), np.array(moment, float)
    if elements is None:
        tip = Cantilever(length, 1 / stiff, 1 / bending, *loads).tip()
    else:
        nodes = np.linspace(0, [length, 0, 0], elements + 1)
        tip = tip_of_elements(nodes, 1 / stiff, 1 / bending, *loads)
    return {"u": length - tip[0], "x": tip[0] - length, "y": tip[1], "z": tip[2]}


def bend(
    radius: float,
    degrees: float,
    load: float,
    stretching: list[float],
    bending: list[float],
    elements: int | None = None,
) -> Parts:
    """An arc from the clamp, pulled out of its plane at its tip; or `elements` along it."""
    turn, force = math.radians(degrees), np.array([0, 0, load])
    yielding = 1 / np.array(stretching), 1 / np.array(bending)
    turns = np.linspace(0, turn, (elements or 1) + 1)
    nodes = radius * np.column_stack([np.sin(turns), 1 - np.cos(turns), np.zeros(len(turns))])
    if elements is None:
        rod = Cantilever(radius * turn, *yielding, force=force, curvature=lambda s: 1 / radius)
        tip = rod.tip()
    else:
        tip = tip_of_elements(nodes, *yielding, force, np.zeros(3))
    moved = tip - nodes[-1]
    return dict(zip("xyzuvw", map(float, [*tip, *moved]), strict=True))


def parabola_bend(
    points: list[list[float]], load: float, stretching: list[float], bending: list[float]
) -> Parts:
    """The same of a rod along the parabola through three points, the first of them the origin."""
    x, y = np.array(points, dtype=float).T
    line = np.polynomial.Polynomial.fit(x, y, 2).convert()
    slope, bent = line.deriv(), line.deriv(2)
    rod = Cantilever(
        points[-1][0],
        1 / np.array(stretching),
        1 / np.array(bending),
        force=np.array([0, 0, load]),
        curvature=lambda x: float(bent(x)) / (1 + float(slope(x)) ** 2) ** 1.5,
        speed=lambda x: math.hypot(1, float(slope(x))),
        turned=math.atan(float(slope(0.0))),
    )
    moved = rod.tip() - [*points[-1], 0]
    return dict(zip("uvw", map(float, moved), strict=True))


_LOADS = 4  # steps to the whole load
_ITERATIONS = 60  # of the strains of one element, which shrink with its size
_SETTLED = 1e-14
_MISSED = 1e-10  # of the moments at the tip, relative to the loads'


def tip_of_elements(
    nodes: Floats, stretching: Floats, bending: Floats, force: Floats, moment: Floats
) -> Floats:
    """Where the last node rests under dead loads there, by shooting from the clamped first one.

    In straight elements of constant strain, the simplest there are of rods: what a source computed
    with few is computed here with as many, so that what these make of a difference is seen. One
    point of integration an element, Simo and Vu-Quoc 1986; compliances as a `Cantilever` has
    them, nodes in the plane z = 0.
    """
    chords = np.diff(nodes, axis=0)
    sizes = np.linalg.norm(chords, axis=1)
    along = chords / sizes[:, None]
    across = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(along))])
    frames = np.stack([along, across, np.broadcast_to([0, 0, 1], along.shape)], axis=2)
    scale = float(np.linalg.norm(force) * sizes.sum() + np.linalg.norm(moment))

    def march(moment_left: Floats, load: float) -> tuple[Floats, Floats]:
        place, turned = np.zeros(3), np.eye(3)
        for own, size in zip(turned @ frames, sizes, strict=True):
            bent, now = np.zeros(3), turned @ own
            for _ in range(_ITERATIONS):
                middle = now @ Rotation.from_rotvec(bent * size / 2).as_matrix()
                strain = np.eye(3)[0] + stretching * (middle.T @ (load * force))
                chord = size * (middle @ strain)
                before = bent
                bent = bending * (middle.T @ (moment_left - np.cross(chord / 2, load * force)))
                if np.abs(bent - before).max() * size < _SETTLED:
                    break
            turned = now @ Rotation.from_rotvec(bent * size).as_matrix() @ own.T
            place, moment_left = place + chord, moment_left - np.cross(chord, load * force)
        return place, moment_left

    def missed(scaled: Floats, load: float) -> Floats:
        return np.asarray((march(scale * scaled, load)[1] - load * moment) / scale)

    scaled = np.zeros(3)
    for load in np.linspace(0, 1, _LOADS + 1)[1:]:
        scaled = root(missed, scaled, args=(load,), tol=1e-13).x
    if not np.abs(missed(scaled, 1.0)).max() <= _MISSED:
        raise ArithmeticError(f"{len(sizes)} elements do not come to rest")
    return march(scale * scaled, 1.0)[0]
