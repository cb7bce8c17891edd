"""Random foreign models to inspect and fix: ``python -m tests.fuzz.models N [SEED [SWEPT]]``.

Each is a vibrissa as others write one (hinges, pairs of hinges, balls, with frames between links,
MuJoCo 4's flex or MuJoCo 3's cable, on a mocap body, a slide, a weld, a wrist or a mesh, in units
from um to m and from mg to kg), written badly in up to three of the ways of `MISTAKES` and
otherwise in up to four of `tests.fuzz.ways`; or, one in four, such a one, a URDF or a shipped
chain, flex or cable, in which some numbers are others, or something was added. A line a model says
what was planted, and as flags:

- ``internal``: anything but a line of an `InputError`;
- ``refused``: a line of an `InputError`, if nothing is garbled;
- ``missed``: a planted mistake that no fault names;
- ``false``: a fault of a model in which none is planted;
- ``left``: fixed, faults of that kind are still there;
- ``outside``: swept as fixed, it is outside of the expected interval, or of its case's limits.

Without a seed it takes a new one, from the clock. The exit code is 1 if there is a flag but
``outside``, or more than one in twenty of those that were swept is outside.
"""

import random
import re
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from rich.console import Console

from analytic import InputError, solve_sweep
from compare import compare
from compare.read.case import load_case
from compare.simulate.expected import SPEED, expected
from compare.simulate.fixing import case_of, fix
from compare.simulate.inspection import Inspection
from mujoco_models import available_beams, inspect_model, shipped_models, simulate_model
from tests.compare.simulate.published import cable
from tests.fuzz.ways import WAYS, rewritten
from tests.mujoco_models.inspect.rods import Rod

FAULTY = 0.05  # of the swept; the interval is one of 95 per cent


@dataclass
class Model:
    """A vibrissa of length L and rigidity EI, of first period T1 as its mass makes it."""

    links: int = 20
    length: float = 1.0
    rigidity: float = 1.0
    mass: float = 0.313
    joints: str = "hinge"  # or pair, ball, framed: with a frame fixed between links
    carrier: str = "motor"  # or mocap, slide, weld, servo, mesh
    lead: float = 0.5  # links before the first joint
    first: float = 1.0  # times as stiff
    odd: int = 0  # a link that is too stiff
    timestep: float = 0.01  # T1
    integrator: str = "discrete"
    weight: float = 0.0  # by which gravity pulls the vibrissa aside [EI/L^2]
    damping: float = 0.0159  # T1 times the stiffness: a twentieth of critical
    contact: str = 'condim="1" solimp="0.98 0.98 0.001"'
    solref: float = 2.0  # time steps
    site: str = ""
    limit: str = ""
    loss: float = 0.0  # friction of a joint [EI/L]
    flag: str = ""
    solver: str = ""
    rail: str = ""  # of the slide
    motor: str = ""
    sensors: tuple[str, ...] = ("force", "torque")
    planted: list[str] = field(default_factory=list)
    ways: list[str] = field(default_factory=list)  # of writing it
    soft: str = ""  # a flex or a cable, as MJCF

    @property
    def period(self) -> float:
        """T1 of the uniform vibrissa."""
        return float(1.787 * (self.mass * self.length**3 / self.rigidity) ** 0.5)

    def text(self) -> str:
        """As MJCF."""
        if self.soft:
            return self.soft
        h, t1 = self.length / self.links, self.period
        # As hard in any unit of time; MuJoCo's defaults are so soft that they hold little.
        loss = f'frictionloss="{self.loss * self.rigidity / self.length:.8g}"'
        loss = f'{loss} solreffriction="-1 {-1e7 / t1:.8g}"' if self.loss else ""
        hard = f'solreflimit="{-3e4 / t1**2:.8g} {-300 / t1:.8g}"' if self.limit else ""
        held = f"{self.limit} {hard} {loss}"
        pull = self.weight * self.rigidity / (self.mass * self.length**2)
        count = self.links if self.lead < 1 else self.links - 1
        bodies, weight = "", self.mass / self.links
        frame = "<body>" if self.joints == "framed" else ""
        for i in range(1, count + 1):
            k = self.rigidity / h * (self.first if i == 1 else 1.0) * (1.5 if i == self.odd else 1)
            spring = f'stiffness="{k:.8g}" damping="{self.damping * t1 * k:.8g}"'
            joint = {
                "hinge": f'<joint axis="0 0 1" {spring} {held}/>',
                "pair": f'<joint axis="0 0 1" {spring} {held}/><joint axis="1 0 0" {spring}/>',
                "ball": f'<joint type="ball" {spring}/>',
                "framed": f'<joint axis="0 0 1" {spring} {held}/>',
            }[self.joints]
            long = h * (1 - self.lead % 1) if i == count else h
            place = self.lead * h if i == 1 else h
            bodies += (
                f'<body name="link{i}" pos="0 {place:.8g} 0">{joint}'
                f'<geom fromto="0 0 0 0 {long:.8g} 0" mass="{weight * long / h:.8g}"/>'
                f"{frame}"
            )
        where = f'<site name="clamp" {self.site}/>'
        stub = (
            f'<geom fromto="0 0 0 0 {self.lead * h:.8g} 0" mass="{weight}"/>' if self.lead else ""
        )
        inside = f"{where}{stub}{bodies}{'</body>' * count * (1 + len(frame) // 6)}"
        sensors = "".join(f'<{word} site="clamp"/>' for word in self.sensors)
        return (
            f'<mujoco model="foreign">\n<compiler angle="radian" boundinertia="1.1e-15"/>\n'
            f'<option timestep="{self.timestep * t1:.8g}" integrator="{self.integrator}" '
            f'{self.solver} gravity="{pull:.8g} 0 0"><flag {self.flag}/></option>\n'
            f'<default><geom type="capsule" size="{0.005 * self.length:.8g}" {self.contact} '
            f'solref="{self.solref * self.timestep * t1:.8g} 1"/></default>\n'
            f"<worldbody>{self._carried(inside)}</worldbody>\n<sensor>{sensors}</sensor>\n"
            f"{self._beside()}</mujoco>"
        )

    def _carried(self, inside: str) -> str:
        inertia, length = 1e6 * self.mass, self.length
        slide = (
            f'<joint name="rail" type="slide" axis="1 0 0" armature="{inertia:.8g}" {self.rail}/>'
        )
        moments = _thrice(self.mass * length**2)
        weight = f'<inertial pos="0 0 0" mass="{self.mass}" diaginertia="{moments}"/>'
        wrist = f'<joint name="wrist" axis="0 0 1" stiffness="{5e3 * self.rigidity / length:.8g}"/>'
        turned = f'<body name="wrist">{weight}{wrist}{inside}</body>'
        mesh = f'<geom type="mesh" mesh="m" mass="{self.mass}" contype="0" conaffinity="0"/>'
        return {
            "motor": f'<body name="foot">{slide}{weight}{inside}</body>',
            "slide": f'<body name="foot">{slide}{weight}{inside}</body>',
            "mocap": f'<body name="foot" mocap="true">{inside}</body>',
            "servo": f'<body name="foot">{slide}{weight}{turned}</body>',
            "mesh": f'<body name="foot">{slide}{mesh}{inside}</body>',
            "weld": f'<body name="hand" mocap="true"/><body name="foot"><freejoint/>{weight}'
                    f'{inside}</body>',
            "fixed": f'<body name="foot">{inside}</body>',
        }[self.carrier]  # fmt: skip

    def _beside(self) -> str:
        gain = 1e8 * self.mass / self.period
        motor = f'<velocity joint="rail" kv="{gain:.8g}" {self.motor}/>'
        a = 0.05 * self.length
        corners = f"0 0 0 {a} 0 0 0 {-a} 0 0 0 {a}"
        return {
            "motor": f"<actuator>{motor}</actuator>",
            "servo": f'<actuator>{motor}<motor joint="wrist"/></actuator>',
            "mesh": f'<asset><mesh name="m" vertex="{corners}"/></asset>'
                    f"<actuator>{motor}</actuator>",
            "weld": '<equality><weld body1="hand" body2="foot"/></equality>',
        }.get(self.carrier, "")  # fmt: skip


ADDED = (
    "", "",
    '<tendon><fixed><joint joint="rail" coef="1"/></fixed></tendon>',
    '<tendon><spatial stiffness="1"><site site="clamp"/><site site="clamp"/></spatial></tendon>',
    '<equality><joint joint1="rail"/></equality>',
    '<equality><connect body1="link3" anchor="0 0 0"/></equality>',
    '<equality><weld body1="link3" body2="link5"/></equality>',
    '<contact><exclude body1="link1" body2="link3"/></contact>',
    '<option><flag contact="disable"/></option>',
    '<compiler angle="degree" balanceinertia="true"/>',
)  # fmt: skip
_FEW, _MANY = 13, 35  # links
_GARBLED, _SOFT = 0.25, 0.15  # of all


def drawn_urdf(rng: random.Random) -> str:
    """A chain of rods on continuous joints, which URDF gives no springs."""
    links, length = rng.randint(3, 20), 10 ** rng.uniform(-3, 2)
    text = '<robot name="r"><link name="link0"/>'
    for i in range(1, links + 1):
        text += (
            f'<link name="link{i}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" '
            f'ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry><cylinder radius="0.1" '
            f'length="{length}"/></geometry></collision></link><joint name="j{i}" '
            f'type="continuous"><parent link="link{i - 1}"/><child link="link{i}"/>'
            f'<origin xyz="0 0 {length}"/><axis xyz="1 0 0"/></joint>'
        )
    return text + "</robot>"


def _thrice(x: float) -> str:
    return f"{x:.8g} {x:.8g} {x:.8g}"


def _changed(**values: object) -> Callable[[Model], None]:
    return lambda model: vars(model).update(values)


# What is planted, by the subject of the fault that should name it.
MISTAKES: dict[str, Callable[[Model], None]] = {
    "clamp, start": _changed(lead=0.0),
    "clamp, end": _changed(lead=1.0),
    "clamp, soft": _changed(first=0.4),
    "uniformity": _changed(odd=4),
    "contact, soft": _changed(solref=20.0),
    "contact, friction": _changed(contact='solimp="0.98 0.98 0.001"'),
    "contact, slippery": _changed(contact='friction="0" solimp="0.98 0.98 0.001"'),
    "contact, nothing": _changed(contact='condim="1" contype="0" conaffinity="0"'),
    "time step, long": _changed(timestep=0.2),
    "time step, explicit": _changed(integrator="Euler"),
    "limits": _changed(limit='limited="true" range="-0.01 0.01"'),
    "friction in joints": _changed(loss=0.3),
    "damping": _changed(damping=0.8),
    "solver": _changed(solver='solver="CG" iterations="1" tolerance="1e-2"'),
    "force sensor, turned": _changed(site='euler="0 0 0.2"'),
    "force sensor, none": _changed(sensors=()),
    "gravity": _changed(weight=0.1),
    "flags, override": _changed(flag='override="enable"'),
    "flags, constraint": _changed(flag='constraint="disable"'),
    "foot, range": _changed(rail='limited="true" range="-1e-9 1e-9"'),
    "foot, weak": _changed(motor='forcelimited="true" forcerange="-1e-20 1e-20"'),
    "foot, none": _changed(carrier="fixed"),
}
_ALL = ("motor", "slide", "mocap", "servo", "mesh", "weld")
_CARRIERS = {  # that have what a mistake changes
    "foot, range": ("motor", "slide", "servo", "mesh"),
    "foot, weak": ("motor", "servo", "mesh"),
}
UNITS = {"m": 1.0, "cm": 1e2, "mm": 1e3, "um": 1e6}  # of a whisker of 0.1 m
MASSES = {"kg": 1.0, "g": 1e3, "mg": 1e6}


def drawn(rng: random.Random) -> Model:
    """A whisker of a steel wire, more or less, in some units, with some mistakes."""
    unit, mass = rng.choice([*UNITS.values()]), rng.choice([*MASSES.values()])
    length = 0.1 * rng.uniform(0.3, 3)
    model = Model(
        links=rng.randint(8, 40),
        length=length * unit,
        rigidity=6.4e-4 * 10 ** rng.uniform(-2, 1) * mass * unit**3,
        mass=1.5e-4 * 10 ** rng.uniform(-1, 1) * mass,
        joints=rng.choice(["hinge", "framed", "pair", "ball"]),
        carrier=rng.choice(["motor", "motor", "slide", "mocap", "servo", "mesh", "weld"]),
    )
    for name in rng.sample([*MISTAKES], rng.randint(0, 3)):
        if model.carrier in _CARRIERS.get(name, _ALL) and not (
            model.joints == "ball" and name in ("limits", "friction in joints")
        ):
            MISTAKES[name](model)
            model.planted.append(name)
    model.ways = rng.sample([*WAYS], rng.randint(0, 4))
    if model.carrier == "weld" and "flags, constraint" in model.planted:
        model.carrier = "motor"  # as nothing would hold it
    if model.carrier == "fixed" and "with a ball" in model.ways:
        model.ways.remove("with a ball")  # as it would be the object that moves
    return model


def drawn_soft(rng: random.Random) -> Model:
    """A flex, or a cable, whose first edge is rigid or clamped in its middle."""
    links, length = rng.randint(15, 25), 0.1 * rng.uniform(0.9, 1.3)
    if "cable" in available_beams():
        text = cable(length, 2.5e-4, 2.1e11, 8e10, links, 'damping="1e-4"', 'condim="1"').text
        return Model(links, length, soft=text, planted=["clamp, end"])
    rigid = rng.random() < _GARBLED
    text = Rod(links, length, ahead=0.0 if rigid else 0.5).text
    return Model(links, length, soft=text, planted=["clamp, end"] if rigid else [])


@dataclass
class Outcome:
    """What came of a model."""

    model: Model
    said: str = ""
    flags: list[str] = field(default_factory=list)
    swept: bool = False


def garbled(rng: random.Random) -> str:
    """Another one's text with a number that is another, or with something added."""
    text = rng.choice([drawn(rng).text(), *(p.read_text() for p in shipped_models().values())])
    numbers = list(re.finditer(r"(?<=[\" ])-?[0-9.]+(e-?[0-9]+)?(?=[\" ])", text))
    for one in sorted(rng.sample(numbers, 2), key=lambda one: -one.start()):
        new = float(one[0]) * rng.choice([0, -1, 1e-6, 1e6, 1e300, 2, 0.5])
        text = f"{text[: one.start()]}{new:g}{text[one.end() :]}"
    return text.replace("</mujoco>", rng.choice(ADDED) + "</mujoco>")


def trial(rng: random.Random, folder: Path, sweep: bool = False) -> Outcome:
    """Inspect and fix one; sweep it as fixed."""
    outcome = Outcome(drawn_soft(rng) if rng.random() < _SOFT else drawn(rng))
    path = folder / "foreign.xml"
    path.write_text(rewritten(outcome.model.text(), outcome.model.ways, folder, rng))
    garbled_too = not sweep and rng.random() < _GARBLED
    if garbled_too:
        outcome.model.planted = []
        path.write_text(garbled(rng))
        if rng.random() < _GARBLED:
            path = path.with_suffix(".urdf")
            path.write_text(drawn_urdf(rng))
    try:
        before = Inspection(inspect_model(path))
        found = {fault.subject for fault in before.faults}
        planted = {name.split(",")[0] for name in outcome.model.planted}
        outcome.said = f"{sorted(found)}"
        if planted - found - _hidden(outcome.model):
            outcome.flags.append(f"missed {sorted(planted - found)}")
        if not garbled_too and not planted and found - _own(outcome.model):
            outcome.flags.append(f"false {sorted(found)}")
        after = fix(path, {}, before, path.with_name("fixed.xml"))
        left = {fault.subject for fault in after.inspection.faults}
        outcome.said += f" -> {sorted(left)}"
        if outcome.model.planted and left - _stays(outcome.model):
            outcome.flags.append(f"left {sorted(left)}")
        if sweep and not left:
            _sweep(outcome, after.inspection, after.files[0])
    except InputError as error:
        outcome.said = str(error)
        if "\n" in outcome.said:
            outcome.flags.append("internal")
        elif not garbled_too:
            outcome.flags.append("refused")
    except Exception as error:  # the point of this
        outcome.said, outcome.flags = f"{type(error).__name__}: {error}", ["internal"]
    return outcome


def _hidden(model: Model) -> set[str]:
    """What another mistake makes harmless."""
    hidden = {"time step"} if model.integrator == "Euler" else set()
    # A spring that is explicit may be slow enough for the step, or an overdamped one be stable.
    if "damping" in model.planted or model.odd >= model.links:
        hidden |= {"damping", "uniformity"}
    if model.carrier == "weld":
        hidden |= {"force sensor", "foot", "solver"}
    if model.links > _MANY:  # of so light ones limits give way by more than a sweep bends them
        hidden |= {"limits"}
    if re.search("contact|damping|step|none|weak", str(model.planted)):
        hidden |= {"solver"}
    if "flags, constraint" in model.planted:
        hidden |= {"solver", "contact", "time step", "limits", "friction in joints"}
    return hidden


def _own(model: Model) -> set[str]:
    """Faults of a model in which nothing is planted."""
    of_carrier = {"weld": {"clamp"}, "mocap": {"foot"}}
    return _stays(model) | of_carrier.get(model.carrier, set())


def _stays(model: Model) -> set[str]:
    """What no number fixes: the sensors of a body that is free, and too few links."""
    of_weld = {"force sensor", "torque sensor"} if model.carrier == "weld" else set()
    return of_weld | ({"large bending"} if model.links < _FEW else set())


def _sweep(outcome: Outcome, inspection: Inspection, file: Path) -> None:
    case = file.with_name("case.toml")
    case.write_text(case_of(inspection.found, file, {}))
    job = load_case(case)
    moved = simulate_model(job.case, job.model, job.motion, job.settings)
    found = compare(solve_sweep(job.case), moved, job.tolerances)
    worst = max(part.rms for part in found.disagreement.values())
    low, high = expected(inspection.found, SPEED).interval
    outcome.said += f" {low:.1e} < {worst:.1e} < {high:.1e}, {(~moved.trusted).sum()} untrusted"
    outcome.swept = True
    outcome.said += "".join(f", {one.clause}" for one in found.exceeded)
    if not low < worst < high or found.exceeded:
        outcome.flags.append("outside")


def main(count: int, seed: int, swept: int = 0) -> int:
    """Try some; 1 if something is wrong."""
    console = Console(highlight=False, soft_wrap=True)
    console.print(f"{count} models, seed {seed}")
    outside = wrong = done = 0
    with tempfile.TemporaryDirectory() as folder:
        for i in range(count):
            outcome = trial(random.Random(f"{seed} {i}"), Path(folder), i < swept)
            outside += "outside" in outcome.flags
            done += outcome.swept
            wrong += any(flag != "outside" for flag in outcome.flags)
            model = outcome.model
            kind = "of a flex or cable" if model.soft else f"{model.joints} on {model.carrier}"
            about = f"{model.links} {kind}, L = {model.length:.3g}, {', '.join(model.ways)}"
            console.print(f"{i}: {about}, {model.planted} {outcome.said} {outcome.flags or ''}",
                          markup=False)  # fmt: skip
    console.print(f"{wrong} wrong, {outside} of {done} outside")
    return int(wrong > 0 or outside > FAULTY * done)


if __name__ == "__main__":
    words = [int(word) for word in sys.argv[1:]]
    sys.exit(main(words[0], words[1] if len(words) > 1 else time.time_ns() % 10**6, *words[2:3]))
