"""Obstacles: meshes of files, exact polygons, and the smooth primitive, which has no facets."""

from dataclasses import replace
from functools import cache

import mujoco
import numpy as np
import pytest
import trimesh

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Profile,
    Sweep,
    circle,
    ellipse,
    mesh_section,
    named_case,
    polygon,
    solve_sweep,
)
from compare import compare
from mujoco_models import Settings, available_beams, simulate_sweep
from mujoco_models.model.spec import add_options
from mujoco_models.obstacles.file_mesh import FileMesh
from mujoco_models.obstacles.kinds import place
from mujoco_models.obstacles.prism import Prism

ROUND = 2 * np.pi * np.arange(200) / 200
RING = np.column_stack([np.cos(ROUND), 0.5 * np.sin(ROUND)])


def prism():
    body = trimesh.creation.cylinder(radius=1, height=1, sections=200)
    body.vertices *= [1, 0.5, 1]
    return body


def bicone():
    """Nowhere a prism, but symmetric about the plane z = 0, in which its rim lies."""
    rim = np.column_stack([RING, np.zeros(200)])
    return trimesh.convex.convex_hull(np.vstack([rim, [[0, 0, 0.4], [0, 0, -0.4]]]))


def section(body, tmp_path, height=0.0, **placed):
    body.export(tmp_path / "body.stl")
    return mesh_section(tmp_path / "body.stl", offset=(0.0, 0.9), height=height, **placed)


def swept(profile, segments=20, **settings):
    case = Case(profile=profile, sweep=Sweep(stations=20))
    return simulate_sweep(case, Settings(segments=segments, **settings))


def rms(reference, candidate):
    found = compare(reference, candidate)
    return max(found.disagreement[name].rms for name in CLAMP_READINGS)


@pytest.mark.slow
@pytest.mark.parametrize("make", [prism, bicone])
def test_a_files_mesh_is_its_section_to_the_vibrissa(make, tmp_path):
    profile = section(make(), tmp_path)
    assert profile.solid.tilt < 1e-9
    assert isinstance(place(Case(profile=profile), Settings()), FileMesh)
    on_file = swept(profile)
    assert on_file.provenance["obstacle"].startswith("mesh body.stl with ")
    assert (on_file.table["status"] == "ok").all()
    # Single precision of the vertices; observed 2e-7.
    assert rms(swept(replace(profile, solid=None)), on_file) < 2e-6
    # Between two beads a corner of 200 is held anywhere within half its turn, 1.6e-2 rad.
    # Observed 8e-3, in force_x.
    assert rms(solve_sweep(Case(profile=profile, sweep=Sweep(stations=20))), on_file) < 1.6e-2


@pytest.mark.slow
def test_a_files_mesh_goes_where_it_is_put(tmp_path):
    """Other axes, unit and place in the file, and the object's mirror image: the same sweep."""
    upright = section(prism(), tmp_path)
    body = prism()
    body.vertices = 30 * (body.vertices[:, [2, 1, 0]] + [0.1, 0, 0])
    body.invert()
    turned = section(body, tmp_path, height=3.0, scale=1 / 30, axes="zy")
    table = swept(turned).table
    np.testing.assert_allclose(table["force_y"], swept(upright).table["force_y"], atol=1e-3)
    assert turned.solid.vertices[:, 2].max() == pytest.approx(0.5, abs=1e-6)
    volume = trimesh.convex.convex_hull(turned.solid.vertices).volume
    assert volume == pytest.approx(prism().volume, rel=1e-6)

    to_right = Case(profile=turned.mirrored(), sweep=Sweep(stations=20, direction="right"))
    mirrored = simulate_sweep(to_right, Settings(segments=20)).table
    np.testing.assert_allclose(mirrored["force_y"], table["force_y"], atol=1e-6)


@pytest.mark.slow
def test_a_tilted_side_is_refused_if_its_section_is_not_what_is_touched(tmp_path):
    """A cone: a bead of radius r touches sides tilted by 45 degrees at r sqrt(2)."""
    cone = trimesh.creation.cone(1.0, 1.0, sections=400)
    profile = mesh_section(_file(cone, tmp_path), offset=(0, 1.2), height=0.2)
    assert profile.solid.tilt == pytest.approx(np.sqrt(0.5), abs=1e-4)
    with pytest.raises(InputError, match=r"tilt of mesh body.stl = 0.79 rad .* touch it 2.1e-03 L"):
        swept(profile)
    thin = Case(Beam(radius=1e-4), profile, Sweep(stations=12))  # r (sqrt(2) - 1) = 4e-5
    obstacle = simulate_sweep(thin, Settings(segments=10)).provenance["obstacle"]
    assert "by up to 7.1e-01" in obstacle


def _file(body, tmp_path):
    body.export(tmp_path / "body.stl")
    return tmp_path / "body.stl"


def test_tilt_of_edges_in_the_plane(tmp_path):
    """Two halves of different slope meet in the plane: the less tilted one counts, if both lean."""
    rims = [(1.0, 0.0), (0.9, 0.5), (1.05, -0.5)]
    layers = [np.column_stack([r * RING, np.full(200, z)]) for r, z in rims]
    body = trimesh.convex.convex_hull(np.vstack(layers))
    tilt = mesh_section(_file(body, tmp_path)).solid.tilt
    assert tilt == pytest.approx(0.1, abs=0.02)


def test_meshes_that_cannot_be_simulated(tmp_path):
    profile = section(prism(), tmp_path)
    huge = replace(profile.solid, vertices=np.zeros((50_001, 3)))
    with pytest.raises(InputError, match=r"mesh body.stl = of 50001 vertices: must be .* 50000"):
        swept(replace(profile, solid=huge))
    with pytest.raises(InputError, match=r"section of body.stl.* must be below 1 L"):
        Case(profile=mesh_section(_file(prism(), tmp_path), offset=(0, 5)))
    with pytest.raises(InputError, match=r"section of body\.stl: must be 'mesh'"):
        swept(section(prism(), tmp_path), obstacle="primitive")


def test_a_polygon_is_exact():
    hexagon = np.column_stack([np.cos(ROUND[::33]), 1.4 + np.sin(ROUND[::33])])[:6]
    case = Case(profile=polygon(hexagon))
    obstacle = Prism.of(case, 3200)
    inside = [any(np.allclose(v, w) for w in hexagon) for v in obstacle.vertices]
    assert sum(inside) == len(case.profile.vertices[case.profile.vertices[:, 1] < 1])
    assert obstacle.normal_error == obstacle.chord_error == 0


def test_the_end_of_an_open_object_is_touched_at_any_angle():
    short = Profile(
        xi=np.sin, eta=lambda a: 1.4 - np.cos(a), alpha_range=(-0.3, 0.3), label="short arc"
    )
    found = swept(short, segments=10)
    assert (found.table["status"] == "ok").all()
    assert found.table["contact_angle"].max() > 1


def test_distance_from_a_corner_is_that_of_the_vertex():
    box = Prism.of(Case(profile=polygon([(0, 0.4), (1, 0.4), (1, 1.4), (0, 1.4)])), 0)
    assert box.clearance(np.array([1.3, 0.0]))[0] == pytest.approx(0.5)
    assert box.clearance(np.array([0.5, 0.41]))[0] == pytest.approx(-0.01)
    points = np.array([[0.5, 0.396], [1.3, 0.4], [0.5, 0.39]])
    assert box.near(points, 0.005).tolist() == [0]
    assert box.near(points, np.array([0.003, 0.31, 0.011])).tolist() == [1, 2]


@pytest.mark.parametrize(
    "profile",
    [circle(1.0, (0.0, 0.4)), ellipse((1.0, 0.5), (0.0, 0.4)), named_case("catenary").profile],
)
def test_errors_of_the_polygon_are_as_stated(profile):
    """Distance and angle between the polygon and the contour, by brute force."""
    case = Case(profile=profile)
    obstacle = Prism.of(case, 100)
    last, first = case.reach
    alpha = np.linspace(last, first, 5000)
    at = profile.at(alpha)
    points = np.column_stack([at.xi, at.eta])
    farthest = max(abs(obstacle.clearance(point)[0]) for point in points)
    assert farthest == pytest.approx(obstacle.chord_error, rel=0.1)
    turn = np.diff(obstacle.facet_angles)
    assert obstacle.normal_error == pytest.approx(turn.max() / 2)


def own_facets(prism, window):
    """Those about which a window has all of the contour: they are in a row, of four or more."""
    count = len(prism.facet_angles)
    own = {i for i in range(0, count, 4) if prism.is_inside(window, np.array([i, i + 1.0]))}
    about = {i + j for i in own or range(count) for j in range(-3, 4)} - own
    own |= {i for i in about if 0 <= i < count and prism.is_inside(window, np.array([i, i + 1.0]))}
    return sorted(own)


def with_a_bead(prism, radius):
    """MuJoCo's model of the prism and a bead that is free to be put anywhere."""
    spec = mujoco.MjSpec()
    add_options(spec)
    prism.add_to(spec)
    bead = spec.worldbody.add_body()
    bead.add_freejoint()
    bead.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[radius, 0, 0], conaffinity=1, gap=0.01)
    return spec.compile()


def pressed(prism, model, facet, share, distance):
    """MuJoCo's contacts of the bead at a distance from a facet, and the facet's normal."""
    begin, end = prism.vertices[facet : facet + 2]
    normal = np.array([end[1] - begin[1], begin[0] - end[0]])
    normal /= np.hypot(*normal)
    data = mujoco.MjData(model)
    data.qpos[:2] = begin + share * (end - begin) + distance * normal
    mujoco.mj_forward(model, data)
    return data, normal


@pytest.mark.parametrize(
    ("body", "points"),
    [(circle(0.0383, (0.0, 0.4476)), 1000), (ellipse((0.094, 10.4), (0.0, 0.339)), 800),
     (ellipse((0.083, 5.1), (0.0, 0.15)), 4000), (ellipse((5.1, 0.083), (0.0, 0.5)), 4000),
     (circle(0.002, (0.0, 0.5)), 100), (polygon([[-0.3, 0.7], [0.0, 0.5], [1e-3, 0.7]]), 100)],
    ids=["small circle", "needle", "fine needle", "lying needle", "small", "thin wedge"],
)  # fmt: skip
def test_mujocos_contacts_are_those_of_the_polygon(body, points):
    """What keeps the precision inside a mesh must not stick out of it, however small it is.

    And facets as short as 1e-6 L are not turned by single precision, wherever the contour is long.
    """
    radius, draw = 1.3e-3, np.random.default_rng(3)
    prism = Prism.of(Case(Beam(radius=radius), body), points)
    model = with_a_bead(prism, radius)
    turn = np.pad(np.diff(prism.facet_angles), (0, 1), mode="edge")
    for window in range(prism.windows):
        prism.show(model, 0, window)
        for facet in draw.choice(own_facets(prism, window), 40):
            depth = 10 ** draw.uniform(-9, -5)
            data, normal = pressed(prism, model, facet, draw.uniform(0.1, 0.9), radius - depth)
            exact = prism.clearance(data.qpos[:2])[0] - radius
            deepest = data.contact.dist.argmin()
            # Single precision over the size of a window: 4e-7 along the lying needle's flank.
            assert data.contact.dist[deepest] == pytest.approx(exact, abs=1e-6)
            found = data.contact.frame[deepest, :2]
            # Observed 0.017; 13 where windows were as long as the flank's facets are.
            assert abs(found[0] * normal[1] - found[1] * normal[0]) < 0.1 * turn[facet]


@pytest.mark.parametrize("count", [2, 3, 4, 5])
def test_no_contact_is_missed_on_a_body_of_few_corners(count):
    """A climb from corner to corner finds none at 11 in 100 places on a prism of three."""
    radius, draw = 1e-3, np.random.default_rng(count)
    slopes = np.sort(draw.uniform(-1, 1, size=count - 1))
    edges = draw.uniform(0.1, 0.4, (count - 1, 1)) * np.array([np.cos(slopes), np.sin(slopes)]).T
    lower = np.cumsum(np.vstack([[[-0.4, 0.5]], edges]), axis=0)
    prism = Prism(lower, (-1.2, 1.2), exact=True, radius=radius, corner_radius=1e-6)
    model = with_a_bead(prism, radius)
    for window in range(prism.windows):
        prism.show(model, 0, window)
        for _ in range(100):
            edge, depth = draw.integers(count - 1), 10 ** draw.uniform(-7, -3)
            data, _ = pressed(prism, model, edge, draw.uniform(0.05, 0.95), radius - depth)
            assert data.ncon > 0
            # Single precision of places as far as 1 L.
            assert data.contact.dist.min() == pytest.approx(-depth, abs=1e-6)


def test_a_line_that_turns_passes_from_vertex_to_vertex_without_a_jump():
    """Or a bead that slides to where its link touches has no place where the link lies flat."""
    prism = Prism.of(Case(Beam(radius=2e-3), ellipse((0.15, 9.9), (0.0, 0.46))), 300)
    low, high = prism.facet_angles[[0, -1]]
    finest = np.diff(prism.facet_angles).min()
    slopes = np.arange(low, high, finest / 200)[: 200 * 50]
    places = np.array([prism.support(slope) for slope in slopes])
    facet = np.hypot(*np.diff(prism.vertices, axis=0).T).max()
    assert np.hypot(*np.diff(places, axis=0).T).max() < facet / 10
    between = (prism.facet_angles[1:] + prism.facet_angles[:-1]) / 2
    touched = np.array([prism.support(slope) for slope in between])
    assert touched == pytest.approx(prism.vertices[1:-1], abs=0)
    # On either side of its slope angle it lies on the facet, and on no other one.
    flat = np.array([prism.support(slope) for slope in prism.facet_angles])
    assert flat == pytest.approx((prism.vertices[1:] + prism.vertices[:-1]) / 2, abs=1e-12)


NEEDLE = Case(Beam(radius=0.002), ellipse((0.09, 3.2), (0.0, 0.25)), Sweep(stations=40))


def test_the_nearest_facet_of_a_needle():
    """Beside a tip that is sharper than a bead: against all facets, one by one."""
    obstacle = Prism.of(NEEDLE, 1600)
    low = obstacle.lowest
    draw = np.random.default_rng(3)
    out = np.array([np.sin(a := draw.uniform(-1.2, 1.2, 400)), -np.cos(a)]).T
    points = low + 0.004 * draw.uniform(0.2, 2, (400, 1)) * out
    begin, run = obstacle.vertices[:-1], np.diff(obstacle.vertices, axis=0)
    off = points[:, None] - begin
    along = np.clip((off * run).sum(axis=2) / (run**2).sum(axis=1), 0, 1)
    exact = np.hypot(*np.moveaxis(off - along[..., None] * run, 2, 0)).min(axis=1)
    window = obstacle.window_of(float(obstacle.place(np.zeros(1))[0]))
    found, _ = obstacle.gap(window, points)
    np.testing.assert_allclose(found, exact, atol=1e-9)  # single precision from the tip on


def test_the_distance_of_a_needle_from_far_away():
    """Far off, what rounds vertices is more than what one facet is nearer than the next one."""
    obstacle = Prism.of(NEEDLE, 1600)
    draw = np.random.default_rng(4)
    points = np.column_stack([draw.uniform(-0.3, 0.3, 200), draw.uniform(0, 0.24, 200)])
    exact = [obstacle.clearance(point)[0] for point in points]
    for window in range(0, obstacle.windows, 10):
        np.testing.assert_allclose(obstacle.gap(window, points)[0], exact, atol=1e-6)


CASES = {
    "circle": Case(profile=circle(1.0, lowest=(0.0, 0.4)), sweep=Sweep(stations=30)),
    "ellipse": Case(profile=ellipse((1.0, 0.5), lowest=(0.0, 0.4)), sweep=Sweep(stations=30)),
    "two-circles": Case(profile=named_case("two-circles").profile, sweep=Sweep(stations=30)),
}
FLOOR = 5e-5  # rms, relative: what the contacts' softness and the beads' spacing leave


@cache
def errors(name, beam, segments):
    simulated = simulate_sweep(
        CASES[name], Settings(beam=beam, segments=segments, obstacle="primitive")
    )
    assert (simulated.table["status"] == "ok").all()
    found = compare(solve_sweep(CASES[name]), simulated)
    return np.array([found.disagreement[reading].rms for reading in CLAMP_READINGS])


@pytest.mark.parametrize("name", CASES)
def test_agrees_with_the_closed_form(name):
    # Observed at most 5.4e-4, in force_y; the mesh has 1e-3.
    assert (errors(name, "chain", 40) < 8e-4).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("beam", "name"),
    [*(("chain", name) for name in CASES), *((beam, "circle") for beam in available_beams()[1:])],
)
def test_second_order_until_the_floor(beam, name):
    """Single doublings scatter about 2: the beads' spacing is bounded by more than N."""
    segments = np.array([10, 20, 40, 80, 160] if beam == "chain" else [10, 20, 40, 80])
    found = np.array([errors(name, beam, int(n)) for n in segments])
    slopes = -np.polyfit(np.log(segments), np.log(found), 1)[0]
    assert (slopes > 1.8).all(), (found, slopes)
    assert (slopes < 2.4).all(), (found, slopes)
    if beam == "chain":
        assert (found[-1] < FLOOR).all(), found[-1]


@pytest.mark.parametrize("name", CASES)
def test_contacts_lie_on_the_contour(name):
    """As deep in it as the load presses them, and with its normal there."""
    case = CASES[name]
    table = simulate_sweep(case, Settings(obstacle="primitive")).table
    table = table[table["phase"] == "tip"]  # one bead, so that nothing is averaged
    at = case.profile.at(table["contact_angle"].to_numpy())
    across = np.hypot(table["contact_x"] - at.xi, table["contact_y"] - at.eta)
    depth = np.hypot(table["force_x"], table["force_y"]) / Settings().contact_stiffness
    # MuJoCo puts a contact half its depth inside; the circles are 5e-5 rad apart.
    assert (np.abs(across - depth / 2) < 1e-8).all()


@pytest.mark.parametrize(
    "profile",
    [
        polygon([(-1.0, 0.8), (-0.5, 0.5), (0.3, 0.4), (1.0, 0.9)]),
        Profile(np.sin, lambda alpha: 1.4 - np.cos(alpha), (-0.3, 1.0)),  # ends within reach
    ],
)
def test_corners_have_no_circle(profile):
    with pytest.raises(InputError, match="'mesh', or a contour without corners"):
        simulate_sweep(Case(profile=profile), Settings(obstacle="primitive"))
