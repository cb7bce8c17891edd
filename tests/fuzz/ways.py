"""How else a random foreign model may be written without being another one: other MJCF of it."""

import math
import random
import re
from collections.abc import Callable
from pathlib import Path

Way = Callable[[str, Path, random.Random], str]

_LINK = r'(<body name="link\d+" [^>]*>)'
_GEOM = r'<geom fromto="0 0 0 0 ([^ ]*) 0" mass="([^"]*)"/>'


def _turned(text: str, folder: Path, rng: random.Random) -> str:
    """Its world is turned and moved by a frame."""
    angles = " ".join(f"{rng.uniform(-1.5, 1.5):.3f}" for _ in range(3))
    frame = f'<frame euler="{angles}" pos="0.1 -0.2 0.3">'
    return text.replace("<worldbody>", f"<worldbody>{frame}").replace(
        "</worldbody>", "</frame></worldbody>"
    )


def _in_degrees(text: str, folder: Path, rng: random.Random) -> str:
    """Angles are in degrees, in another order of axes, and limits go without saying."""
    text = text.replace('angle="radian"', 'angle="degree" eulerseq="ZYX" autolimits="true"')
    text = text.replace('euler="0 0 0.2"', 'euler="11.4591559 0 0"')
    limits = 'limited="true" range="-0.01 0.01"'
    return text.replace(limits, 'range="-0.572957795 0.572957795"')


def _in_classes(text: str, folder: Path, rng: random.Random) -> str:
    """What its geoms and joints have is that of a class, which the foot's children inherit."""
    own = re.search(r"<default>(.*?)</default>", text)
    assert own is not None
    text = text.replace(own[0], f'<default><default class="whisker">{own[1]}</default></default>')
    return text.replace('<body name="foot"', '<body name="foot" childclass="whisker"')


def _in_two_files(text: str, folder: Path, rng: random.Random) -> str:
    """Defaults and sensors are in a file that is included."""
    parts = re.findall(r"<default>.*</default>|<sensor>.*?</sensor>", text)
    for part in parts:
        text = text.replace(part, "")
    (folder / "parts.xml").write_text(f"<mujocoinclude>{''.join(parts)}</mujocoinclude>")
    return text.replace("<worldbody>", '<include file="parts.xml"/><worldbody>', 1)


def _keyed(text: str, folder: Path, rng: random.Random) -> str:
    """It has a keyframe."""
    return _with(text, '<keyframe><key name="home" time="1"/></keyframe>')


def _seen(text: str, folder: Path, rng: random.Random) -> str:
    """Each link is seen as a mesh, which nothing touches."""
    size = _length(text) / 100
    corners = f"0 0 0 {size} 0 0 0 {size} 0 0 0 {size}"
    seen = '<geom type="mesh" mesh="seen" contype="0" conaffinity="0" mass="0"/>'
    text = re.sub(_LINK, rf"\1{seen}", text)
    return _with(text, f'<asset><mesh name="seen" vertex="{corners}"/></asset>')


def _with_posts(text: str, folder: Path, rng: random.Random) -> str:
    """Posts stand far away, made by `replicate`."""
    far, apart = 9 * _length(text), _length(text)
    post = f'<geom type="sphere" size="{apart / 9}" pos="{far} 0 0"/>'
    many = f'<replicate count="3" offset="0 0 {apart}">{post}</replicate>'
    return text.replace("<worldbody>", f"<worldbody>{many}", 1)


def _with_tendon(text: str, folder: Path, rng: random.Random) -> str:
    """A tendon measures a length."""
    text = re.sub(_LINK, r'\1<site name="on-it"/>', text, count=1)
    path = '<site site="clamp"/><site site="on-it"/>'
    measured = '<sensor><tendonpos tendon="t"/></sensor>'
    return _with(text, f'<tendon><spatial name="t">{path}</spatial></tendon>{measured}')


def _loosely_tied(text: str, folder: Path, rng: random.Random) -> str:
    """An equality constraint is switched off, and two links do not touch."""
    off = '<equality><connect body1="link3" anchor="0 0 0" active="false"/></equality>'
    return _with(text, off + '<contact><exclude body1="link1" body2="link3"/></contact>')


def _with_a_ball(text: str, folder: Path, rng: random.Random) -> str:
    """A ball is free, far away."""
    place, size = 9 * _length(text), _length(text) / 50
    mass = re.search(r'mass="([^"]*)"', text)
    assert mass is not None
    geom = f'<geom type="sphere" size="{size}" {mass[0]}/>'
    ball = f'<body name="ball" pos="0 0 {place}"><freejoint/>{geom}</body>'
    return text.replace("<worldbody>", f"<worldbody>{ball}", 1)


def _of_cylinders(text: str, folder: Path, rng: random.Random) -> str:
    """Its links are cylinders."""
    return text.replace('type="capsule"', 'type="cylinder"')


def _meshed(text: str, folder: Path, rng: random.Random) -> str:
    """Its links are meshes: prisms with twelve sides."""
    radius = _length(text) / 200
    meshes = ""
    for long in dict.fromkeys(long for long, _ in re.findall(_GEOM, text)):
        ring = [(radius * math.cos(a * math.pi / 6), radius * math.sin(a * math.pi / 6))
                for a in range(12)]  # fmt: skip
        corners = " ".join(f"{x:.8g} {y} {z:.8g}" for y in (0, long) for x, z in ring)
        meshes += f'<mesh name="rod{long}" vertex="{corners}"/>'
    text = re.sub(_GEOM, r'<geom type="mesh" mesh="rod\1" mass="\2"/>', text)
    return _with(text, f"<asset>{meshes}</asset>")


def _beaded(text: str, folder: Path, rng: random.Random) -> str:
    """Each link has two geoms, made by `replicate`."""

    def beads(link: re.Match[str]) -> str:
        half, mass = float(link[1]) / 2, float(link[2]) / 2
        geom = f'<geom fromto="0 0 0 0 {half:.8g} 0" mass="{mass:.8g}"/>'
        return f'<replicate count="2" offset="0 {half:.8g} 0">{geom}</replicate>'

    return re.sub(_GEOM, beads, text)


def _turned_back(text: str, folder: Path, rng: random.Random) -> str:
    """Each link's geom runs from its end to its joint, by a frame."""
    frame = r'<frame pos="0 \1 0" quat="0 0 0 1">\g<0></frame>'
    return re.sub(_GEOM, frame, text)


def _attached(text: str, folder: Path, rng: random.Random) -> str:
    """Its links are a model of their own, which is attached to the foot."""
    start = end = text.index('<body name="link1"')
    depth = 0
    for tag in re.finditer(r"<(/?)body\b[^>]*>", text[start:]):
        depth += -1 if tag[1] else 1
        if not depth:
            end = start + tag.end()
            break
    links = text[start:end]
    if 'childclass="whisker"' in text:  # which is not handed on to what is attached
        links = links.replace("<body ", '<body childclass="whisker" ', 1)
    head = re.findall(r"<compiler[^>]*>|<default>.*</default>|<asset>.*?</asset>", text)
    (folder / "links.xml").write_text(
        f"<mujoco>{''.join(head)}<worldbody>{links}</worldbody></mujoco>"
    )
    text = text[:start] + text[end:]
    text = re.sub(r'(body\d?|site)="(link\d+|on-it)"', r'\1="w-\2"', text)
    attach = '<attach model="links" body="link1" prefix="w-"/>'
    text = f"{text[:start]}{attach}{text[start:]}"
    return _with(text, '<asset><model name="links" file="links.xml"/></asset>')


def _of_many_options(text: str, folder: Path, rng: random.Random) -> str:
    """It has two options, one of them with flags that are as they are by default."""
    return text.replace("<option ", '<option><flag energy="enable"/></option><option ', 1)


def _length(text: str) -> float:
    """Of the vibrissa, by its radius."""
    size = re.search(r'type="c[a-z]*" size="([^"]*)"', text)
    assert size is not None
    return 200 * float(size[1])


def _with(text: str, more: str) -> str:
    return text.replace("</mujoco>", f"{more}</mujoco>")


WAYS: dict[str, Way] = {
    "turned": _turned,
    "in degrees": _in_degrees,
    "in classes": _in_classes,
    "keyed": _keyed,
    "seen": _seen,
    "with posts": _with_posts,
    "with a tendon": _with_tendon,
    "loosely tied": _loosely_tied,
    "with a ball": _with_a_ball,
    "of cylinders": _of_cylinders,
    "meshed": _meshed,
    "beaded": _beaded,
    "turned back": _turned_back,
    "attached": _attached,
    "of many options": _of_many_options,
    "in two files": _in_two_files,
}


def rewritten(text: str, names: list[str], folder: Path, rng: random.Random) -> str:
    """A model's text in some of the ways, in the order of `WAYS`: files last."""
    for name, way in WAYS.items():
        text = way(text, folder, rng) if name in names else text
    return text
