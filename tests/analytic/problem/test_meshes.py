"""Sections of mesh files: whatever programs write, and whatever damage does to it."""

import sys

import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from analytic import Case, Sweep, circle, find_events, mesh_section
from analytic.problem.contours.polygon import Polygon
from tests.analytic.problem.given import refusal

FORMATS = ["stl", "obj", "ply", "off", "glb"]


def beyond(body, points):
    """How far points lie outside of the planes of the hull of a body."""
    planes = ConvexHull(body).equations
    return (points @ planes[:, :3].T + planes[:, 3]).max(axis=1)


def assert_square(section: Polygon, half: float) -> None:
    np.testing.assert_allclose(section.vertices, [[-half, -half], [half, -half]], atol=1e-7 * half)
    assert section.solid.tilt == 0
    assert len(section.solid.vertices) == 8


def test_a_vertex_far_away_leaves_no_faces(tmp_path):
    """As one damaged byte of an exponent does: beside it, all others are at one place."""
    box = trimesh.creation.box((1, 1, 1))
    box.vertices[0] = 1e33
    box.export(tmp_path / "box.stl")
    assert "0 triangles with an area, in a size of" in refusal(mesh_section, tmp_path / "box.stl")


@pytest.mark.parametrize("suffix", ["obj", "glb"])
def test_seams_are_merged(tmp_path, suffix):
    """A corner of its own for every face, as for textures and flat shading."""
    split = trimesh.creation.box()
    split.unmerge_vertices()
    split.visual = trimesh.visual.TextureVisuals(uv=split.vertices[:, :2] + split.vertices[:, 2:])
    split.export(tmp_path / f"box.{suffix}")
    assert_square(mesh_section(tmp_path / f"box.{suffix}"), 0.5)


@pytest.mark.parametrize("turned_over", [slice(0), slice(None), slice(None, None, 2)])
@pytest.mark.parametrize(("suffix", "size"), [("stl", 1e-38), ("stl", 1e37), ("ply", 1e9)])
def test_any_unit_of_length_and_faces_that_look_inside(tmp_path, suffix, turned_over, size):
    box = trimesh.creation.box((size,) * 3)
    box.faces[turned_over] = box.faces[turned_over][:, ::-1]
    box.export(tmp_path / f"box.{suffix}")
    assert_square(mesh_section(tmp_path / f"box.{suffix}"), size / 2)


def test_hull_on_request(tmp_path):
    ring = tmp_path / "ring.stl"
    trimesh.creation.annulus(0.5, 1.0, 1.0).export(ring)
    assert "hull = true" in refusal(mesh_section, ring)
    full = tmp_path / "full.stl"
    trimesh.creation.cylinder(1.0, 1.0, sections=32).export(full)
    np.testing.assert_allclose(
        mesh_section(ring, hull=True).vertices, mesh_section(full).vertices, atol=1e-6
    )
    open_box = trimesh.creation.box()
    open_box.update_faces(np.arange(12) > 1)
    open_box.export(tmp_path / "open.stl")
    assert "hull = true" in refusal(mesh_section, tmp_path / "open.stl")
    assert_square(mesh_section(tmp_path / "open.stl", hull=True), 0.5)
    assert "mesh hull" in refusal(mesh_section, tmp_path / "open.stl", hull="no")


def test_simplified_within_a_tolerance(tmp_path):
    """All vertices of the file stay within the stated distance of the body that is left."""
    ball = trimesh.creation.icosphere(4)
    ball.export(tmp_path / "ball.stl")
    section = mesh_section(tmp_path / "ball.stl", tolerance=1e-2)
    assert len(section.solid.vertices) < len(ball.vertices) / 4
    assert 0 < beyond(section.solid.vertices, ball.vertices).max() <= 1e-2
    assert "simplified within" in section.label


def test_a_section_is_that_of_the_body(tmp_path):
    """A sphere cut beside its middle: a circle to the accuracy of its facets, tilted all round."""
    trimesh.creation.icosphere(5).export(tmp_path / "ball.ply")
    section = mesh_section(tmp_path / "ball.ply", offset=(0.2, 1.3), height=0.6)
    radius = np.hypot(section.vertices[:, 0] - 0.2, section.vertices[:, 1] - 1.3)
    np.testing.assert_allclose(radius, 0.8, atol=1e-3)
    assert section.solid.tilt == pytest.approx(0.6, abs=0.03)
    assert section.solid.gap(0.01) == pytest.approx(0.01 * (1 / 0.8 - 1), rel=0.1)
    found = find_events(section).snap_off.foot_x
    assert found == pytest.approx(find_events(circle(0.8, (0.2, 0.5))).snap_off.foot_x, abs=1e-2)


@pytest.mark.parametrize("angle", [0.0, 0.2, 0.5])
def test_tilt_of_a_tilted_prism(tmp_path, angle):
    """A box turned about the x-axis: the normal of its lower side leaves the plane by the angle."""
    box = trimesh.creation.box((1.0, 0.5, 3.0))
    box.apply_transform(trimesh.transformations.rotation_matrix(angle, [1, 0, 0]))
    box.export(tmp_path / "tilted.ply")
    section = mesh_section(tmp_path / "tilted.ply")
    assert section.solid.tilt == pytest.approx(np.sin(angle), abs=1e-6)
    assert section.solid.gap(0.005) == pytest.approx(0.005 * (1 / np.cos(angle) - 1), abs=1e-8)


def test_what_is_not_opened(tmp_path):
    for name in ("m.zip", "m.3mf", "m"):
        (tmp_path / name).touch()
        assert "*.stl" in refusal(mesh_section, tmp_path / name)
    assert "check the path" in refusal(mesh_section, tmp_path / "missing.stl")
    (tmp_path / "cut.ply").write_bytes(trimesh.creation.box().export(file_type="ply")[:300])
    assert "a readable STL, OBJ" in refusal(mesh_section, tmp_path / "cut.ply")
    trimesh.creation.box().export(tmp_path / "box.stl")
    assert "move the plane" in refusal(mesh_section, tmp_path / "box.stl", height=0.6)


BODIES = {
    "ball": lambda: trimesh.creation.icosphere(2),
    "box": trimesh.creation.box,
    "cylinder": lambda: trimesh.creation.cylinder(0.5, 1.0, sections=24),
    "capsule": lambda: trimesh.creation.capsule(1.0, 0.4, count=[8, 8]),
    "cone": lambda: trimesh.creation.cone(0.5, 1.0, sections=12),
}


@seed(21)
@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.sampled_from(sorted(BODIES)),
    st.sampled_from(FORMATS),
    st.tuples(*[st.floats(0.3, 3)] * 3),
    st.tuples(*[st.floats(0, 1)] * 3),
    st.floats(-1, 6),  # text formats have eight decimals
    st.floats(-0.4, 0.4),
)
def test_any_body_anyhow_turned_has_its_section(
    tmp_path_factory, name, suffix, stretch, turn, size, height
):
    """Stretched, turned, in any unit: convex, on the body's hull, and swept without a word."""
    file = tmp_path_factory.mktemp("mesh") / f"body.{suffix}"
    body = BODIES[name]()
    body.apply_scale(stretch)
    body.apply_transform(trimesh.transformations.random_rotation_matrix(np.array(turn)))
    body.apply_scale(10**size)
    body.export(file)
    deep = body.extents[2]
    extent = body.extents.max()
    place = float(body.bounds[:, 2].mean() + height * deep)
    section = mesh_section(file, scale=1 / extent, height=place)
    corners = np.insert(section.vertices, 2, place / extent, axis=1)
    # Files hold single precision, or six digits.
    assert np.abs(beyond(body.vertices / extent, corners)).max() < 1e-5
    lowest = section.vertices[:, 1].min()
    moved = mesh_section(file, scale=1 / extent, height=place, offset=(0, 0.4 - lowest))
    assert np.isfinite(Case(profile=moved, sweep=Sweep(stations=10)).foot_x).all()


def test_a_lying_stl_does_not_fill_memory(tmp_path):
    """A header that promises four billion faces."""
    content = trimesh.creation.box().export(file_type="stl")
    (tmp_path / "lying.stl").write_bytes(content[:80] + b"\xff\xff\xff\xff" + content[84:])
    assert "lying.stl" in refusal(mesh_section, tmp_path / "lying.stl")


NAME = "Größe".encode("latin-1")
NAMED = {
    "obj": lambda content: b"# " + NAME + b"\n" + content,
    "off": lambda content: content.replace(b"OFF\n", b"OFF\n# " + NAME + b"\n", 1),
    "ply": lambda content: content.replace(b"1.0\n", b"1.0\ncomment " + NAME + b"\n", 1),
    "stl": lambda content: NAME.ljust(80) + content[80:],
    "stl_ascii": lambda content: b"solid " + NAME + content[content.index(b"\n") :],
}


@pytest.mark.parametrize("kind", NAMED)
def test_comments_in_any_encoding(tmp_path, kind, monkeypatch):
    """Sound files with a name in Latin-1, where a package that guesses encodings is missing."""
    monkeypatch.setitem(sys.modules, "charset_normalizer", None)
    content = trimesh.creation.box().export(file_type=kind)
    file = tmp_path / f"box.{kind.removesuffix('_ascii')}"
    file.write_bytes(NAMED[kind](content.encode() if isinstance(content, str) else content))
    assert_square(mesh_section(file), 0.5)


def test_a_closed_needle_is_not_open(tmp_path):
    """Triangles of its caps are 1e-9 of its size high: they close it, flat as they are."""
    slope = np.linspace(0, 2 * np.pi, 1000, endpoint=False)
    support = np.hypot(0.083 * np.sin(slope), 5.1 * np.cos(slope))
    ring = np.column_stack([0.083**2 * np.sin(slope), -(5.1**2) * np.cos(slope)]) / support[:, None]
    ends = [np.insert(ring, 2, z, axis=1) for z in (-0.5, 0.5)]
    trimesh.convex.convex_hull(np.concatenate(ends)).export(tmp_path / "needle.obj")
    found = mesh_section(tmp_path / "needle.obj", height=0.0)
    assert len(found.vertices) == pytest.approx(501, abs=1)  # its lower side


@pytest.mark.parametrize(("height", "tilted"), [(0.5, False), (0.02, True)])
def test_the_rim_of_a_tilted_cone_is_no_side(tmp_path, height, tilted):
    """Near its base the plane leaves the cone through the rim, which lies nearly in the plane."""
    cone = trimesh.creation.cone(radius=4.0, height=400.0, sections=64)
    turn = trimesh.transformations.rotation_matrix(0.05, [1.0, 1.0, 0.0])
    cone.apply_transform(turn)
    cone.apply_translation([0, 0, -cone.bounds[0][2]])
    cone.export(tmp_path / "cone.stl")
    solid = mesh_section(tmp_path / "cone.stl", height=height).solid
    assert (solid.tilt > 0.5) is tilted
