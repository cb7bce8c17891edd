"""A model file of a user's, MJCF or URDF, with whatever it includes."""

import re
from pathlib import Path

import mujoco

from analytic.problem.errors import InputError
from analytic.problem.files import regular_file
from mujoco_models.quiet import unlogged

_LARGEST = 50_000_000  # bytes of the file itself; assets are MuJoCo's matter
_SUFFIXES = (".xml", ".urdf")  # MuJoCo reads by the name what an object is to be added to
_REMEDIES = (
    (r"flex with general attachments", "a flex that is a beam needs MuJoCo 4"),
    (r"plugin|composite", "only MuJoCo 3 has composite cables: pip install 'mujoco==3.17.*'"),
    (r"opening file|resource", "put its files where it says, or correct meshdir"),
    (
        r"mass and inertia",
        'give each moving body a mass; to one too thin, <compiler boundinertia="2e-15"/>',
    ),
)


FORCE, TORQUE = "vibrissa-force", "vibrissa-torque"
"""Names of the sensors that are added at a site."""


def load(path: Path, site: str | None = None) -> mujoco.MjModel:
    """Read and compile a model; nothing of its files is changed."""
    if path.suffix not in _SUFFIXES:
        raise InputError(
            "model", path, f"named {' or '.join(f'*{suffix}' for suffix in _SUFFIXES)}", "rename it"
        )
    regular_file(path, "model", _LARGEST)
    try:
        with unlogged():
            if site is None:
                return mujoco.MjModel.from_xml_path(str(path))
            return spec_of(path, site).compile()
    except InputError:
        raise
    except (ValueError, mujoco.FatalError) as error:
        said = " ".join(str(error).split())[:300]
        remedy = next(
            (remedy for words, remedy in _REMEDIES if re.search(words, said, re.IGNORECASE)),
            "correct the file",
        )
        raise InputError(
            "model", path, "a model that MuJoCo takes", f"{remedy} ({said})"
        ) from error


def spec_of(path: Path, site: str | None = None) -> mujoco.MjSpec:
    """A model as it can be added to, in memory."""
    spec = mujoco.MjSpec.from_file(str(path))
    if site is None:
        return spec
    known = [one.name for one in spec.sites if one.name]
    if site not in known:
        shown = ", ".join(known[:12]) or "none with a name"
        raise InputError("--site", repr(site), "the name of a site of the model", f"it has {shown}")
    for name, kind in (
        (FORCE, mujoco.mjtSensor.mjSENS_FORCE), (TORQUE, mujoco.mjtSensor.mjSENS_TORQUE),
    ):  # fmt: skip
        spec.add_sensor(name=name, type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=site)
    return spec
