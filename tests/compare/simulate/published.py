"""Published whiskers, cables and tentacles, rebuilt from their numbers, straight on a slide.

What each piece has (length, stiffness, dampers, armature, mass, shape, limits), and contacts, time
step, integrator and gravity, are as published; sensors are at the clamp. Time steps of less than a
5,000th of the first period are ten times and more as long, for speed.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import accumulate, pairwise

PLUGIN = 'plugin="mujoco.elasticity.cable"'


@dataclass(frozen=True)
class Published:
    """A vibrissa along x on its slide, as MJCF."""

    inside: str  # of the body on the slide
    option: str = ""
    before: str = ""  # of the world
    gravity: str = "0 0 0"
    inertia: float = 10.0  # of the slide
    hold: float = 1e3  # rate at which its motor takes up a speed; Euler's steps are explicit in it

    @property
    def text(self) -> str:
        """The whole file."""
        moments = " ".join(3 * [f"{1e-6 * self.inertia:g}"])
        return (
            f'<mujoco><option gravity="{self.gravity}" {self.option}/>{self.before}<worldbody>'
            f'<body name="base"><joint name="rail" type="slide" axis="0 1 0" armature="'
            f'{self.inertia:g}"/><inertial pos="0 0 0" mass="1e-3" diaginertia="'
            f'{moments}"/><site name="clamp"/>{self.inside}</body></worldbody><actuator><velocity '
            f'joint="rail" kv="{self.hold * self.inertia:g}"/></actuator><sensor><force '
            f'site="clamp"/><torque site="clamp"/></sensor></mujoco>'
        )


def cable(
    size: float, radius: float, bend: float, twist: float, count: int, joint: str, geom: str = "",
    hand: str = "", **mounted: str | float,
) -> Published:  # fmt: skip
    """MuJoCo 3's composite, in a body of its own if there are joints between it and the slide."""
    composite = (
        f'<composite prefix="w" type="cable" curve="s 0 0" count="{count} 1 1" size="{size} 0 0" '
        f'initial="none"><plugin {PLUGIN}><config key="twist" value="{twist}"/>'
        f'<config key="bend" value="{bend}"/></plugin><joint kind="main" {joint}/>'
        f'<geom type="capsule" size="{radius}" {geom}/></composite>'
    )
    inside = f'<body name="shaft">{hand}{composite}</body>' if hand else composite
    return Published(inside, before=f"<extension><plugin {PLUGIN}/></extension>", **mounted)


@dataclass(frozen=True)
class Link:
    """A link, by its joint at its beginning."""

    length: float
    joints: str
    geoms: str


def chain(links: list[Link], lead: str = "", at: float = 0.0, **mounted: str | float) -> Published:
    """Links one on the other, the first at some place of a rigid piece."""
    places = [at, *(link.length for link in links[:-1])]
    bodies = "".join(
        f'<body pos="{place:.7g} 0 0">{link.joints}{link.geoms}'
        for place, link in zip(places, links, strict=True)
    )
    return Published(f"{lead}{bodies}{'</body>' * len(links)}", **mounted)


def capsule(length: float, radius: float, more: str) -> str:
    """From a joint on."""
    return f'<geom type="capsule" fromto="0 0 0 {length:.7g} 0 0" size="{radius:.6g}" {more}/>'


def whip(count: int, length: float, mass: float, spring: str, step: float) -> Published:
    """Balls on rods, hanging from a hand that holds the first rod."""
    h = length / count
    rod = f'<geom type="cylinder" fromto="0 0 0 {h} 0 0" size="0.01" mass="0"/>'
    ball = f'<geom type="sphere" pos="{h} 0 0" size="0.02" mass="{mass}"/>'
    link = Link(h, f'<joint type="hinge" axis="0 0 1" {spring}/>', rod + ball)
    return chain((count - 1) * [link], rod + ball, h, option=f'timestep="{step}"',
                 gravity="9.81 0 0", inertia=1e6, hold=1 / step)  # fmt: skip


def elephant() -> Published:
    joints = "".join(
        f'<joint axis="{axis}" stiffness="100" damping="10" armature="0.05" limited="true" '
        f'range="-12 12"/>'
        for axis in ("0 1 0", "0 0 1")
    )
    links = [Link(0.04, joints, capsule(0.04, 0.02 if i < 5 else 0.015, 'density="1500"'))
             for i in range(10)]  # fmt: skip
    return chain(links, option='timestep="0.002" integrator="implicit"', gravity="0 0 -9.81",
                 inertia=1e6)  # fmt: skip


def spiral() -> Published:
    """Each segment is 0.90525 times as large as the one before."""
    joint = (
        '<joint axis="0 0 1" stiffness="0.05" damping="0.05" armature="0.01" limited="true" '
        'range="-30.56 30.56" solimplimit="0.9 0.95 0.001" solreflimit="0.01 0.5"/>'
    )
    sizes = [0.90525**i for i in range(18)]
    links = []
    for s in sizes:
        half, thick = 0.0147807 * s, 0.0271576 * s
        size = f"{half:.6g} {thick:.6g} {thick:.6g}"
        box = f'<geom type="box" size="{size}" pos="{half:.6g} 0 0" density="1100"/>'
        links.append(Link(0.0295615 * s, joint, box))
    return chain(links, option='timestep="0.005" impratio="10" iterations="50"',
                 gravity="-9.81 0 0", inertia=1e5, hold=100.0)  # fmt: skip


def tentacle() -> Published:
    """Rigid vertebrae on ligaments that taper from 3.4 to 1.5 mm."""
    at = [14.3255, 34.275, 52.814, 70.0425, 86.0535, 100.9325, 114.76, 127.61, 139.55, 150.649,
          160.962, 170.55, 179.453, 187.73, 195.42, 202.571, 209.2135, 215.3875, 221.1245,
          226.4565]  # fmt: skip
    lengths = [b - a for a, b in zip(at, [*at[1:], 230.871], strict=True)]
    links = []
    for i, length in enumerate(lengths):
        d, thick = (a * (b / a) ** (i / 19) for a, b in ((3.4e-3, 1.5e-3), (0.93e-3, 0.5e-3)))
        k = 2e7 * math.pi * d**4 / 64 / thick
        joint = f'<joint type="ball" stiffness="{k:.5g}" damping="{0.07 * k:.5g}"/>'
        links.append(Link(1e-3 * length, joint, capsule(1e-3 * length, d / 2, "")))
    return chain(links, capsule(1e-3 * at[0], 1.7e-3, ""), 1e-3 * at[0],
                 option='timestep="0.005" iterations="50"', gravity="-9.81 0 0",
                 inertia=100.0, hold=100.0)  # fmt: skip


def rat() -> Published:
    """A cone of 40 mm in 20 links, in mm and mg: row C, column 1."""
    length, base, tip, young = 40.0, 0.07505, 0.00245, 5e9
    h, links = length / 20, []
    radii = [base + (tip - base) * i / 20 for i in range(21)]
    masses = [math.pi * h / 3 * (a * a + a * b + b * b) * (1260 + 21.5 * (i + 1)) * 1e-3
              for i, (a, b) in enumerate(pairwise(radii))]  # fmt: skip
    beyond = [*accumulate(reversed(masses))][::-1]
    for i in range(1, 20):
        a, rest = radii[i], (20 - i) * h
        k = young * math.pi * a**4 / 4 / length
        centre = rest / 4 * (a * a + 2 * a * tip + 3 * tip**2) / (a * a + a * tip + tip**2)
        damping = 2 * 0.32 * centre * math.sqrt(k * beyond[i])
        spring = f'stiffness="{k:.6g}" damping="{damping:.6g}"'
        joints = "".join(f'<joint axis="{axis}" {spring}/>' for axis in ("0 1 0", "0 0 1"))
        more = f'mass="{masses[i]:.6g}"'
        links.append(Link(h, joints, capsule(h, (radii[i] + radii[i + 1]) / 2, more)))
    lead = capsule(h, (radii[0] + radii[1]) / 2, f'mass="{masses[0]:.6g}"')
    return chain(links, lead, h, option='timestep="0.005"', gravity="0 0 -9810", inertia=1e6,
                 hold=100.0)  # fmt: skip


def mouse() -> Published:
    """One of its hinges is turned by 45 degrees: it twists the whisker, too."""
    spring = 'stiffness="0.02" damping="0.02" armature="0.00065"'
    joints = "".join(f'<joint axis="{axis}" {spring}/>' for axis in ("1 -1 0", "0 0 1"))
    links = 12 * [Link(0.005, joints, capsule(0.005, 0.001, 'mass="1e-7"'))]
    return chain(links, gravity="0 0 -9.81")


WHISKER = (
    0.1, 1.25e-4, 100e9, 40e9, 40, 'damping="0.0001" armature="0.00001"',
    'condim="1" density="6450"',
)  # fmt: skip
SPRINGS = (
    '<joint type="slide" axis="0 1 0" damping="10" stiffness="1000" armature="0.01"/>'
    '<joint type="slide" axis="1 0 0" damping="10" stiffness="100" armature="0.01"/>'
    '<joint type="hinge" axis="0 0 1" damping="0.01" stiffness="1" armature="0.00001"/>'
    '<inertial pos="0 0 0" mass="0.005" diaginertia="1e-6 1e-6 1e-6"/>'
)
CABLES: dict[str, Callable[[], Published]] = {
    # github.com/SVDouble/RatteChan, ratte/models/platform.xml
    "RatteChan": lambda: cable(*WHISKER, option='timestep="0.002" integrator="implicitfast"'),
    # lukedude97.github.io, 2024-06-16: the same on the springs of a magnet
    "Whisker on a magnet": lambda: cable(
        *WHISKER, SPRINGS, option='timestep="0.002" integrator="implicitfast"'
    ),
    # github.com/hao-l1/WhiskerFBG (MIT), mujoco_xml/calibration.xml
    "WhiskerFBG": lambda: cable(
        0.05356, 1.524e-4, 7.5e10, 2.8e10, 40, 'damping="0.005" armature="0.00003"',
        'density="6450" condim="6" friction="0.2 1e-4 1e-4" solref="0.002 1" '
        'solimp="0.15 0.4 0.004 0.9 6"', option='timestep="0.001"', gravity="0 0 -9.81",
    ),
    # github.com/google-deepmind/mujoco (Apache-2.0), model/plugin/elasticity/cable.xml
    "MuJoCo's cable": lambda: cable(
        1.0, 0.005, 4e6, 1e7, 41, 'damping="0.015"', 'condim="1"', gravity="0 0 -9.81",
    ),
    # the same, test/plugin/elasticity/elasticity_test.cc: it is bent into a circle
    "MuJoCo's cantilever": lambda: cable(
        1.0, 0.005, 1e9, 1e6, 41, 'damping="2"', 'density="1"',
    ),
    # github.com/airvlab/cathsim, a guidewire as a cable: its joints add springs of their own
    "CathSim's guidewire": lambda: cable(
        0.3, 0.0008, 1e9, 1e6, 31, 'damping="0.5" stiffness="0.01"',
        'condim="1" density="6450" margin="0.02"', gravity="0 0 -9.81",
        option='timestep="0.004" density="1055" viscosity="0.004" integrator="implicitfast"',
    ),
}  # fmt: skip
CHAINS: dict[str, Callable[[], Published]] = {
    # github.com/mosesnah-shared/whip-project-targeting; Nah et al., BioRob 2020, table 2
    "Whip of 15": lambda: whip(15, 1.5, 0.1, 'stiffness="0.05" damping="0.005"', 0.1),
    # github.com/makepluscode/mojoco-elephant-trunk
    "Elephant's trunk": elephant,
    # github.com/arben24/mujoco_spirob
    "Spiral robot": spiral,
    # a generator of MJCF of a tendon-driven tentacle
    "Tentacle": tentacle,
    # github.com/SeNSE-lab/whiskitphysics, code/src/Whisker.cpp
    "Rat's whisker": rat,
    # github.com/Shavdrag/MouseObstacleAvoidance, models/dynamic_4l_maze_env0.xml
    "Mouse's whisker": mouse,
}
