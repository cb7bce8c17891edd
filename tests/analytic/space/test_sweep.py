"""The closed form in space against the plane, against integration, and against symmetry."""

from functools import cache

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Sweep,
    catenary,
    circle,
    ellipse,
    polygon,
    solve_contact,
    solve_sweep,
)
from analytic.space import (
    FootPath,
    SmoothBody,
    SpatialCase,
    cylinder,
    deflected_rods,
    ellipsoid,
    polyhedron,
    prism,
    rod_residuals,
    solve_space,
    sphere,
)
from analytic.space.problem.readings import CONTACT_POINT, FOOT, FORCE, MOMENT, NORMAL

AXES, CENTRE = np.array([1.0, 0.7, 1.6]), np.array([0.0, 1.1, 0.0])
UPRIGHT, LEANING = (0.0, 1.0, 0.0), (0.1, 1.0, 0.05)


def swept(body, points, stations=40, beam=None, tangent=UPRIGHT, height=0.0):
    path = FootPath(points, height, tangent, stations)
    return solve_space(SpatialCase(beam or Beam(), body=body, path=path))


def events(readings):
    return [(event["kind"], np.array(event["foot"])) for event in readings.provenance["events"]]


BODIES = {
    "sphere": (sphere(1.0, (0.1, 1.4, -0.1)), [[1.3, 0.3], [-1.5, 0.2]]),
    "ellipsoid": (ellipsoid(AXES, CENTRE), [[1.5, 0.3], [-1.5, -0.1]]),
    "cylinder": (cylinder(0.3, (0, 0.8, 0), (0.2, 0.1, 1)), [[1.0, 0.0], [-1.0, 0.5]]),
    "prism": (prism(catenary(0.5, -0.8), (0.2, 0.1, 1)), [[2.5, 0.0], [-1.0, 0.5]]),
    "polyhedron": (
        polyhedron(np.array([[x, y, z] for x in (-0.4, 0.5) for y in (0.4, 1.3) for z in (-1, 1)])),
        [[1.0, 0.3], [-0.2, 0.1]],
    ),
}


@cache
def known(name, tangent):
    """A sweep past one of them that several tests look at."""
    body, points = BODIES[name]
    return swept(body, points, 25, tangent=tangent)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(n, marks=pytest.mark.slow if n in ("polyhedron", "prism") else ())
        for n in BODIES
    ],
)
@pytest.mark.parametrize("tangent", [UPRIGHT, LEANING])
def test_every_state_satisfies_the_equations_of_the_rod(name, tangent):
    readings = known(name, tangent)
    assert readings.touching.sum() >= 5
    assert np.nanmax(rod_residuals(readings)) < 1e-10
    force, moment = readings.values(*FORCE), readings.values(*MOMENT)
    assert np.abs(moment @ readings.clamp_tangent).max(where=readings.touching, initial=0) < 1e-12
    assert np.nanmax(np.abs((force * moment).sum(axis=1))) < 1e-11


def test_contacts_lie_on_the_ellipsoid_and_nothing_inside():
    readings = known("ellipsoid", UPRIGHT)
    on = readings.touching
    contact, normal = (readings.values(*names)[on] for names in (CONTACT_POINT, NORMAL))
    outward = (contact - CENTRE) / AXES**2
    assert np.abs((outward * (contact - CENTRE)).sum(axis=1) - 1).max() < 1e-12
    assert np.abs(normal - outward / np.linalg.norm(outward, axis=1)[:, None]).max() < 1e-12
    axis = (deflected_rods(readings)[readings.trusted] - CENTRE) / AXES
    assert ((axis**2).sum(axis=2) > 1).all()


@pytest.mark.parametrize(
    "contour",
    [
        circle(1.0, (0.0, 0.4)),
        ellipse((0.6, 0.12), (0.0, 0.44)),  # an upright side touches it first
        pytest.param(catenary(0.5, -0.8), marks=pytest.mark.slow),
    ],
)
@pytest.mark.parametrize("radius", [0.0, pytest.param(0.005, marks=pytest.mark.slow)])
def test_a_prism_across_the_path_is_the_planar_problem(contour, radius):
    beam = Beam(2.0, 3.0, radius)
    contour = contour.scaled(2.0)
    flat = solve_sweep(Case(beam, contour, Sweep(60, 5.0, -2.0)))
    space = swept(prism(contour), [[5.0, 0.0], [-2.0, 0.0]], 60, beam)
    held = (flat.values("contact_angle") > 0) & space.touching
    assert held.sum() >= 15
    names = "contact_x", "contact_y", "contact_arc_length", "contact_angle"
    for name in (*CLAMP_READINGS, *names):
        expected = flat.values(name)[held]
        assert np.abs(space.values(name)[held] - expected).max() < 1e-13 * np.abs(expected).max()
    assert (space.table["phase"][held] == flat.table["phase"][held]).all()
    for nothing in ("force_z", "moment_x", "moment_y", "contact_z"):
        assert np.abs(space.values(nothing)[held]).max() < 1e-15


@pytest.mark.slow
@pytest.mark.parametrize("contour", [circle(1.0, (0.0, 0.4)), catenary(0.5, -0.8)])
def test_a_prism_lets_go_where_the_contact_passes_its_lowest_point(contour):
    lowest = float(solve_contact(contour, 0.0)["foot_x"].iloc[0])
    kind, foot = events(swept(prism(contour), [[2.6, 0.0], [-2.0, 0.0]], 30))[-1]
    assert kind == "slip-off"
    assert foot[0] == pytest.approx(lowest, abs=1e-11)


def test_on_a_sphere_the_foot_is_in_the_plane_of_contact_and_axis():
    """A body of revolution gives what its meridian gives, and drops the vibrissa at its axis."""
    readings = swept(sphere(1.0, (0.0, 1.4, 0.0)), [[1.3, 0.3], [-1.5, 0.3]], 50)
    on = readings.touching
    # Next to first contact the planar solver takes the rotation from the height, and loses digits.
    on &= np.linalg.norm(readings.values(*FORCE), axis=1) > 0.1
    away = np.hypot(readings.values("foot_x"), readings.values("foot_z"))[on]
    planar = solve_contact(circle(1.0, (0.0, 0.4)), readings.values("contact_angle")[on])
    assert np.abs(planar["foot_x"] - away).max() < 1e-13
    force = np.linalg.norm(readings.values(*FORCE)[on], axis=1)
    assert np.allclose(force, np.hypot(planar["force_x"], planar["force_y"]), rtol=1e-12, atol=0)
    assert [kind for kind, _ in events(readings)] == ["touch", "phase", "phase", "release"]
    met = circle(1.0, (0.0, 0.4)).offset(0.005)  # where a straight vibrissa's tip touches
    alpha = np.arccos(0.4 / 1.005)
    reach = float(met.at(np.array([alpha])).xi[0])
    for (_, foot), side in ((events(readings)[0], 1), (events(readings)[-1], -1)):
        assert foot[0] == pytest.approx(side * np.sqrt(reach**2 - 0.09), abs=1e-8)
    central = swept(sphere(1.0, (0.0, 1.4, 0.0)), [[1.3, 0.0], [-1.5, 0.0]], 50)
    kind, foot = events(central)[-1]
    assert kind == "slip-off"
    assert np.abs(foot).max() < 1e-11
    assert (central.table["status"] == "slipped off").sum() > 5


@pytest.mark.slow
def test_a_mirror_image_reads_the_mirrored_components():
    body, points = BODIES["ellipsoid"]
    one = known("ellipsoid", LEANING)
    mirror = np.array([1, 1, -1])
    other = swept(body, np.array(points) * [1, -1], 25, tangent=np.array(LEANING) * mirror)
    for names, sign in ((FOOT, mirror), (FORCE, mirror), (MOMENT, -mirror), (NORMAL, mirror)):
        assert np.allclose(
            one.values(*names), other.values(*names) * sign, rtol=0, atol=1e-12, equal_nan=True
        )


@pytest.mark.slow
def test_a_support_function_is_another_way_to_state_an_ellipsoid():
    squares = AXES**2
    smooth = SmoothBody(lambda n: CENTRE + squares * n / np.sqrt(squares @ n**2))
    one, other = (swept(b, BODIES["ellipsoid"][1], 15) for b in (BODIES["ellipsoid"][0], smooth))
    assert np.allclose(one.values(*FORCE), other.values(*FORCE), rtol=0, atol=1e-11, equal_nan=True)
    for (_, a), (_, b) in zip(events(one), events(other), strict=True):
        assert np.abs(a - b).max() < 1e-9


@pytest.mark.slow
def test_a_vibrissa_turns_about_an_edge_whose_normals_it_runs_through():
    readings = swept(*BODIES["polyhedron"], 60)
    on = readings.touching & (readings.table["phase"] == "tangent").to_numpy()
    contact, normal = readings.values(*CONTACT_POINT)[on], readings.values(*NORMAL)[on]
    edge = (normal[:, 0] > 0.02) & (normal[:, 1] < -0.02)
    assert edge.sum() > 5
    assert np.abs(contact[edge] - [0.5, 0.4, 0])[:, :2].max() < 1e-13
    assert np.ptp(normal[edge][:, 0]) > 0.2
    assert np.abs(normal[:, 2]).max() < 1e-13


@pytest.mark.parametrize(
    "body",
    [
        ellipsoid((0.84, 0.23, 0.93), (0, 0.48, 0.1)),
        polyhedron(
            [(-0.5, 0.6, -0.4), (0.5, 0.5, 0.5), (0.6, 0.8, -0.3), (0, 0.4, 0.1), (0, 2, 0)]
        ),
    ],
    ids=["smooth", "edges"],
)
def test_a_line_touches_as_a_vibrissa_that_is_hardly_thicker(body):
    """With its side, next to which a body has no thickness to be within."""
    path = FootPath([[1.3, -0.1], [-1.3, 0.1]], tangent=(0.1, 1, -0.05), stations=20)
    thin, thick = (
        solve_space(SpatialCase(Beam(radius=radius), body=body, path=path)).provenance["events"]
        for radius in (0.0, 1e-9)
    )
    assert [event["kind"] for event in thin] == [event["kind"] for event in thick]
    for one, other in zip(thin, thick, strict=True):
        assert one["travel"] == pytest.approx(other["travel"], abs=1e-8)


def test_a_polyline_with_a_second_contact():
    body = sphere(0.4, (0.0, 1.2, 0.0))
    readings = swept(body, [[1.0, 0.2], [-1.0, 0.2], [-1.0, -0.2], [1.0, -0.2]], 120)
    kinds = [kind for kind, _ in events(readings)]
    assert kinds.count("touch") == 2
    there, back = (readings.values(*FORCE)[i] for i in (slice(0, 50), slice(70, 120)))
    assert np.linalg.norm(there, axis=1).max() > 0.1
    assert np.linalg.norm(back, axis=1).max() > 0.1


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"body": sphere(0.3, (0.0, 1.8, 0.0))}, "at a distance of 0.5196 L"),
        ({"path": FootPath([[0.2, 0.0], [-1, 0]])}, "starts clear of the sphere"),
        ({"path": FootPath([[1.2e5, 0.0], [-1, 0]])}, "1.2e+05 L away"),
        ({"beam": Beam(natural_curvature=-0.2)}, "sweep in space"),
    ],
)
def test_a_case_that_cannot_be_is_refused_in_one_line(change, says):
    given = {"body": sphere(1.0, (0.0, 1.4, 0.0)), "path": FootPath([[1.3, 0.2], [-1.5, 0.2]])}
    with pytest.raises(InputError, match=says.replace("+", r"\+")) as refused:
        SpatialCase(**(given | change))
    assert "\n" not in str(refused.value)


def test_a_path_into_the_body_is_refused():
    with pytest.raises(InputError, match="into the body"):
        swept(sphere(1.0, (0.0, 0.1, 0.0)), [[1.3, 0.2], [-1.5, 0.2]])


@pytest.mark.parametrize("seed", range(5))
def test_the_nearest_point_of_a_prism_is_the_nearest_of_its_section(seed):
    """Of a polygon whose ends are at different heights, and the upright sides above them."""
    draw = np.random.default_rng(seed)
    x = np.sort(draw.uniform(-1, 1, int(draw.integers(3, 9))))
    steep = draw.uniform(0.1, 0.9) * 9 ** (seed % 2)
    line = np.column_stack([x, steep * (x - draw.uniform(-0.5, 0.5)) ** 2])
    body = prism(polygon(line.tolist()))
    tops = line[[0, -1]] + [0, 9]
    around = np.vstack([tops[:1], line, tops[1:]])
    begin, run = around[:-1], np.diff(around, axis=0)
    for point in draw.uniform([-2, -1], [2, 3], (200, 2)):
        share = np.clip(((point - begin) * run).sum(axis=1) / (run**2).sum(axis=1), 0, 1)
        nearest = np.hypot(*(begin + share[:, None] * run - point).T).min()
        under = point[1] < np.interp(point[0], *line.T)
        outside = under or not line[0, 0] < point[0] < line[-1, 0]
        found = body.nearest(np.array([*point, 0.3]), 0.25)
        assert (found.distance > 0) == outside
        assert not outside or found.distance == pytest.approx(nearest, abs=1e-12)
        if abs(found.normal[0]) == 1 and found.point[1] not in line[[0, -1], 1]:
            assert not found.turning.any()
