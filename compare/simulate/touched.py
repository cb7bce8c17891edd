"""What there is to say of what touches: where it is, how hard, and how it rubs."""

from collections.abc import Iterator

import numpy as np

from compare.simulate import treatment
from compare.simulate.remark import (
    EXPLICIT,
    FORCE,
    HARDEST_RUBBING,
    RADIUS,
    SINKS,
    SINKS_RUBBING,
    Remark,
)
from compare.simulate.rigidity import as_intended, contact_stiffness, moving
from mujoco_models.inspect.ahead import HEIGHT
from mujoco_models.inspect.measured import Geom, MeasuredBeam
from mujoco_models.inspect.touching import LEAST_FRICTION

_ASIDE = 0.01  # L; of a geom's axis
# L, beyond the thickness; 0.025 moves readings by 0.4 per cent, 0.039 by 1.0: an object sinks in.
_HOLE = 0.03
_HARDEST = 30.0  # EI/L^3 times the time step [T1] squared
# EI/L^3, at any time step: of 60 stations 3 chatter at 4.8e4, 8 at 9e4, 16 at 1.9e5 and 42 at 8e5,
# of 10, 20 and 40 links alike. Those of a cone differ: if the softest is no harder than it should
# be, the others can be no softer.
_HARDEST_OF_ALL, _SOFT = 5e4, 8e3
# The same over the square of the number of joints: ten take 1e3 at T1/1000, forty at T1/5000
# without chatter (`mujoco_models/quasi-static.md`).
_HARDEST_EXPLICIT = 0.1

_WHOSE = {
    1.0: ", MuJoCo's default,",
    LEAST_FRICTION: ", the least that MuJoCo takes at this condim,",
}


def on_contacts(found: MeasuredBeam) -> Iterator[Remark]:
    """Whether an object meets it, it alone, and as a hard one."""
    meeting_objects = treatment.contacts(found, contype="0", conaffinity="1")
    apart = [geom for geom in found.geoms if geom.kept_apart]
    if apart:
        shown = ", ".join(repr(geom.name) for geom in apart[:4])
        yield Remark("fault", "contact", f"<exclude> keeps {shown} from the world, where objects "
                     "are", "take that <exclude> away")  # fmt: skip
    through = [geom for geom in found.geoms if not (geom.meets or geom.kept_apart)]
    if through and not {"contact", "constraint"}.intersection(dict(found.switched)):
        ends = (through[0].start / found.length, through[-1].end / found.length)
        shown = ", ".join(repr(geom.name) for geom in through[:4])
        yield Remark("fault", "contact", f"{len(through)} of {len(found.geoms)} geoms, s = "
                     f"{ends[0]:.2f} to {ends[1]:.2f} L, meet no object of MuJoCo's default "
                     f"contype and conaffinity: {shown}", edits=meeting_objects)  # fmt: skip
    yield from _course(found)
    for pair in found.self_contacts[:3]:
        own = all(name in {geom.name for geom in found.geoms} for name in pair.split(" and "))
        yield Remark("fault", "contact", f"{pair} touch before anything moves",
                     "exclude the pair" if own else "exclude the pair, or begin farther away",
                     meeting_objects if own else ())  # fmt: skip
    if found.in_the_way and not found.self_contacts:
        count = len(found.in_the_way)
        yield Remark("fault", "contact", f"bent, it touches {count} geoms that move with its foot, "
                     "another vibrissa's perhaps, and not the object alone",
                     edits=treatment.apart(found) if found.springs != "flex" else ())  # fmt: skip
    if found.on_its_way:
        shown = ", ".join(map(repr, found.on_its_way[:4]))
        yield Remark("fault", "contact", f"where its foot goes, it meets {shown}, and not the "
                     "object alone", 'sweep a copy without, or with contype="0" conaffinity="0" '
                     "there")  # fmt: skip
    others = tuple(geom for geom in found.ahead if geom not in found.in_the_way)
    if others:
        some = f"{len(others)} geom{'s' if len(others) > 1 else ''}"
        yield Remark("fault", "contact", f"an object {HEIGHT:g} L ahead meets {some} beside it, on "
                     "its foot or on what its sensors feel",
                     edits=(treatment.unseen(*others),))  # fmt: skip
    meeting = [geom for geom in found.geoms if geom.meets]
    if not meeting:
        return
    softest = min(moving(found) or meeting, key=lambda geom: geom.stiffness)
    sinks, said = FORCE * as_intended(found) / found.length**3 / softest.stiffness, list[str]()
    if sinks > (SINKS_RUBBING if softest.friction else SINKS):
        depth = f"{sinks:.1e} L into the object"
        if sinks * found.length > 2 * softest.radius:
            depth = "deeper into the object than the vibrissa is thick, and slips past"
        said.append(f"{_softness(softest, found)} a force of {FORCE:g} EI/L^2 sinks {depth}")
    hard, fraction = contact_stiffness(found), found.timestep / found.period
    explicit = found.integrator in EXPLICIT
    hardest = _HARDEST_EXPLICIT / len(found.joints) ** 2 if explicit else _HARDEST
    rubs, decay = (max(getattr(g, x) for g in meeting) for x in ("friction", "decay"))
    pyramid = rubs > 0 and found.cone == "pyramidal"
    # An ellipse is softer than what is measured here: how hard that is, is seen when it is one.
    seen = explicit or not pyramid
    if seen and hard * fraction**2 > hardest:
        where = f"{found.integrator} at steps" if explicit else "steps"
        said.append(f"{hard:.2g} EI/L^3 is too hard for {where} of {fraction:.2g} T1: it chatters"
                    f"{' or diverges' if explicit else ''}")  # fmt: skip
    elif seen and hard > _HARDEST_OF_ALL and FORCE / sinks > _SOFT:
        said.append(f"{hard:.2g} EI/L^3 is so hard that it chatters, at any time step")
    off = max((geom.margin for geom in meeting), key=abs)
    if abs(off) > RADIUS * found.length:
        when, like = ("before", "thicker") if off > 0 else ("after", "thinner")
        yield Remark("fault", "contact", f"a margin of {off:.3g} pushes {when} anything touches, "
                     f"as if the vibrissa were so much {like}",
                     edits=treatment.contacts(found, margin="0"))  # fmt: skip
    steps = treatment.steps(found) if said else ()
    # One that is damped more swings as little as a critical one with its damper, and is as hard.
    over = max(1.0, *(geom.damping_ratio for geom in meeting)) ** 2
    most = np.sqrt(HARDEST_RUBBING / (hard * over * decay * found.period))
    chatters = rubs > most
    if pyramid or (chatters and rubs == 1):
        which, cone = _WHOSE.get(rubs, ""), found.cone
        yield Remark("fault", "contact", f"friction {rubs:g}{which} by a {cone} cone chatters",
                     edits=treatment.frictionless(found))  # fmt: skip
    elif chatters:
        said.append(
            f"friction {rubs:g} chatters in contacts of {hard:.2g} EI/L^3 whose damper "
            f"acts within {1 / decay / found.period:.2g} T1, more than {most:.2g} does"
        )
    elif rubs > 0:
        yield Remark("note", "contact", f"friction {rubs:g}; state it in the case, or set "
                     'condim="1"')  # fmt: skip
    if said:
        yield Remark("fault", "contact", "; and ".join(said),
                     edits=(*steps, *treatment.touching(found, rubs)))  # fmt: skip


def _course(found: MeasuredBeam) -> Iterator[Remark]:
    """Whether what can touch is along all of it, and nowhere else."""
    far, reached = max(found.geoms, key=lambda geom: geom.aside), found.joints[0].s
    off, holes = max(found.geoms, key=lambda geom: geom.aside_in_plane), []
    if far.aside > _ASIDE * found.length:
        yield Remark("fault", "contact", f"{far.name!r} stands out from the vibrissa by "
                     f"{far.aside / found.length:.2g} L, and what touches it is no contact of that",
                     edits=(treatment.unseen(far.number),))  # fmt: skip
    elif off.aside_in_plane > RADIUS * found.length:
        yield Remark("fault", "contact", f"the axis of {off.name!r} is "
                     f"{off.aside_in_plane / found.length:.1e} L beside the vibrissa: it touches "
                     "objects by so much too early or too late", "put it on the line of the joints"
                     )  # fmt: skip
    for geom in sorted(found.geoms, key=lambda geom: geom.start):
        if geom.start - reached - 2 * geom.radius > _HOLE * found.length:
            holes.append(f"{reached / found.length:.2f} to {geom.start / found.length:.2f} L")
        reached = max(reached, geom.end)
    if holes:
        more = f", nor at {len(holes) - 1} more places" if len(holes) > 1 else ""
        yield Remark("fault", "contact", f"nothing can touch from s = {holes[0]}{more}: objects "
                     "sink in there", "give each link a geom that collides all along")  # fmt: skip


def _softness(geom: Geom, found: MeasuredBeam) -> str:
    if np.isnan(geom.time_constant):
        return "its stiffness is low:"
    fraction = geom.time_constant / found.period
    return f"solref of {geom.time_constant:g} is {fraction:.2g} of the first period:"
