"""Meshes that are damaged, lie about their size, are no convex solids, or no meshes at all."""

import struct

from tests.fuzz.inputs.dice import Dice
from tests.fuzz.inputs.sound import SUFFIXES, body
from tests.fuzz.inputs.trial import Trial

OTHERS = ("gltf", "3mf", "dae", "xaml", "zip", "step", "stp", "3dxml", "xyz", "ctm", "txt", "STL",
          "svg", "dxf", "vtk", "msh", "zae", "json", "")  # fmt: skip


def mesh(dice: Dice) -> Trial:
    """A mesh file, and a case that uses it."""
    if dice.chance(0.7):
        suffix = dice.pick(*SUFFIXES)
        content = body(dice.pick("ball", "ball", "block", "cylinder", "ring", "spot"), suffix)
        if dice.chance(0.7):
            content = dice.damaged(content)
        if dice.chance(0.1):
            suffix = dice.pick(*SUFFIXES, *OTHERS)
    else:
        suffix = dice.pick(*SUFFIXES, *SUFFIXES, *OTHERS)
        content = _no_mesh(dice)
    name = dice.pick("body", "body", "body", "größe", "[b]", "a b") + f".{suffix}"
    text = f'[profile]\nkind = "mesh"\nfile = "{name}"\noffset = [0, 1.3]\n'
    for key in dice.some(("height", "scale", "axes", "hull", "tolerance"), 2):
        plain = {"hull": "true", "tolerance": "1e-2", "axes": '"xz"', "scale": "0.5"}
        text += f"{key} = {dice.pick(dice.value(), plain.get(key, '0.1'))}\n"
    words = ["run", "case.toml", "--engine", "exact", "--stations", "4", "--out", "out"]
    return Trial("mesh", words, {"case.toml": text.encode(errors="surrogateescape"), name: content})


def _no_mesh(dice: Dice) -> bytes:
    return dice.pick(
        b"", b"solid\nendsolid", b"PK\x03\x04" + bytes(100),
        b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n",
        bytes(80) + struct.pack("<I", 4_000_000_000) + bytes(500),
        b"ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n",
        b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nend_header\n",
        b"v 0 0 0\nv 1 0 0\nv 0 1e38 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 3 4\nf 1 3 4\nf 1 2 4\n",
        b"v 0 0 0\nf 1 2 99\n", b"{}", b"OFF\n1e9 1e9 0\n", b"OFF\n4 4 0\n0 0 0\n",
        b'{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"children": [0]}]}',
        b'{"asset": {"version": "2.0"}, "buffers": [{"uri": "/etc/passwd", "byteLength": 9}]}',
        b"glTF" + struct.pack("<II", 2, 4_000_000_000) + bytes(50),
        b"mtllib /dev/zero\nusemtl x\nv 0 0 0\n", b"<?xml version='1.0'?><COLLADA/>",
        bytes(dice.rng.integers(0, 256, 500, dtype="uint8")),
    )  # fmt: skip
