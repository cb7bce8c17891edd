"""An engine that only steps: it rests, and a fault of its own is seen without any reference."""

import sys
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Beam, Case, Sweep, circle, solve_sweep
from engines import sweep_stepping
from engines.stepping import SteppedRest
from mujoco_models import Settings
from tests.documentation.blocks import ROOT

FOOT_X = (0.5, 0.0, -0.4)  # L; by the tip, and by the side
CASE = Case(profile=circle(1.0, (0.0, 0.4)), sweep=Sweep(stations=15))


@pytest.fixture(scope="module")
def example():
    """The module of the page."""
    folder = str(ROOT / "docs" / "examples" / "engine")
    sys.path.insert(0, folder)
    import stepping_engine

    yield stepping_engine
    sys.path.remove(folder)
    sys.modules.pop("stepping_engine")


def doubts(links: object, case: Case) -> Iterator[str]:
    """Of three stations, one after the other."""
    rest = SteppedRest(case, links)
    for foot_x in FOOT_X:
        row = rest.at(foot_x)
        yield row.doubt if row else "it does not rest"
        rest.accept()


@pytest.mark.slow
def test_the_pages_engine_is_the_rod_to_its_links(example):
    """Of second order, and its snap-off to a tenth of what the links are off."""
    exact = solve_sweep(CASE)
    apart = []
    for segments in (10, 20):
        found = example.ENGINE.sweep(CASE, Settings(segments=segments))
        assert found.trusted.all()
        assert abs(found.snap_off - exact.snap_off) < 2e-3
        off = [found.values(name) - exact.values(name) for name in CLAMP_READINGS]
        apart.append(
            [np.sqrt((x**2).mean()) for x in off] / np.abs(exact.table[list(CLAMP_READINGS)]).max()
        )
    assert np.max(apart[0]) < 6e-3
    assert (np.log2(np.array(apart[0]) / apart[1]) > 1.6).all()


SOUND = {
    "as it is": {},
    "five links": {"count": 5},
    "forty links": {"count": 40},
    "soft contact": {"contact_stiffness": 2e4},
    "hard contact": {"contact_stiffness": 1e7},
}
OTHERS = {
    "small circle": replace(CASE, profile=circle(0.3, (0.0, 0.5))),
    "large circle": replace(CASE, profile=circle(3.0, (0.0, 0.6))),
    "low circle": replace(CASE, profile=circle(1.0, (0.0, 0.25))),
    "high circle": replace(CASE, profile=circle(1.0, (0.0, 0.8))),
    "circle aside": replace(CASE, profile=circle(1.0, (0.1, 0.4))),
    "thin": replace(CASE, beam=Beam(radius=0.001)),
    "thick": replace(CASE, beam=Beam(radius=0.02)),
    "curved": replace(CASE, beam=Beam(natural_curvature=-0.3)),
    "softly held": replace(CASE, clamp_stiffness=10.0),
    "softer to the tip": replace(CASE, beam=Beam(flexural_rigidity=lambda s: 1 - 0.5 * s)),
}
TUNED = {
    "light": {"inertia": 3.0, "period": 60},
    "heavy": {"inertia": 20.0, "period": 160},
    "little damping": {"damping": 0.15},
    "much damping": {"damping": 0.6},
    "more steps than a swing": {"period": 300},
}


@pytest.mark.parametrize(
    ("case", "choice", "tuned"),
    [
        *(pytest.param(CASE, choice, {}, id=name) for name, choice in SOUND.items()),
        *(pytest.param(case, {}, {}, id=name) for name, case in OTHERS.items()),
        *(pytest.param(CASE, {}, tuned, id=name) for name, tuned in TUNED.items()),
    ],
)
def test_a_sound_engine_is_not_blamed(example, case, choice, tuned):
    links = example.Links(case, **choice)
    vars(links).update(tuned)
    assert [*doubts(links, case)] == [""] * 3


def reads(**changed: Callable) -> Callable:
    """A fault in what is reported: of one field, from the whole."""

    def plant(links):
        sound = links.look

        def look():
            state = sound()
            return replace(state, **{name: change(state) for name, change in changed.items()})

        links.look = look

    return plant


def springs(change: Callable) -> Callable:
    def plant(links):
        change(links.springs)

    return plant


def contact(change: Callable) -> Callable:
    """A fault in how it touches: of depth, place, normal and link."""

    def plant(links):
        sound = links.contact
        links.contact = lambda: change(*sound())

    return plant


def scale(*one: int, by: float) -> Callable:
    def change(matrix):
        for i in one or range(len(matrix)):
            matrix[i, i] *= by

    return springs(change)


def asleep(joint: int) -> Callable:
    """A joint that stands still from the beginning of contact on."""

    def plant(links):
        sound = links.step

        def step(foot_x):
            before = links.angles[joint]
            sound(foot_x)
            if foot_x < 0.3:
                links.angles[joint] = before

        links.step = step

    return plant


def pulled(links):
    """A constant moment at every joint, as of an inertia that is not there."""
    sound = links.step

    def step(foot_x):
        sound(foot_x)
        links.angles = links.angles - 2e-3

    links.step = step


def turned(by: float) -> Callable:
    matrix = np.array([[np.cos(by), -np.sin(by)], [np.sin(by), np.cos(by)]])
    return contact(lambda depth, place, normal, link: (depth, place, matrix @ normal, link))


def elsewhere(by: float) -> Callable:
    """Along the vibrissa."""

    def change(depth, place, normal, link):
        return depth, place + by * np.array([-normal[1], normal[0]]), normal, link

    return contact(change)


FAULTS = {
    "all readings are half": reads(
        clamp=lambda s: s.clamp / 2, forces=lambda s: s.forces / 2
    ),  # as PhysX, whose joint and contact agree
    "the clamp reads half": reads(clamp=lambda s: s.clamp / 2),
    "the contact reads half": reads(forces=lambda s: s.forces / 2),
    "the clamp's moment is about another point": reads(
        clamp=lambda s: s.clamp + np.array([0, 0, 0.01 * s.clamp[0]])
    ),
    "the clamp's force is in a turned frame": reads(
        clamp=lambda s: np.array([s.clamp[0] + 0.02 * s.clamp[1], *s.clamp[1:]])
    ),
    "a sign": reads(clamp=lambda s: s.clamp * [-1, 1, 1]),
    "contact forces are counted twice": reads(
        points=lambda s: np.tile(s.points, (2, 1)), forces=lambda s: np.tile(s.forces, (2, 1))
    ),
    "sections are turned otherwise than places say": reads(
        turns=lambda s: 0.02 + 0 * s.joints[1:, 0]
    ),
    "a reading is missing": reads(clamp=lambda s: s.clamp * [1, np.nan, 1]),
    "a spring is 2 % soft": scale(3, by=0.98),
    "the first spring is 2 % stiff": scale(0, by=1.02),
    "all springs are 2 % off": scale(by=1.02),
    "a spring is half as stiff": scale(5, by=0.5),
    "a body sleeps": asleep(4),
    "the first body sleeps": asleep(0),
    "an inertia is missing": pulled,
    "friction": turned(0.05),
    "the contact is 1 % of the length beside its place": elsewhere(0.01),
    "half an element beside its place": elsewhere(-0.025),
    "the object is 1 % too large": contact(lambda d, p, n, i: (d + 0.01, p, n, i)),
    "the object is not felt": contact(lambda d, p, n, i: (d - 1.0, p, n, i)),
}


@pytest.mark.parametrize(
    "plant",
    [
        pytest.param(plant, marks=pytest.mark.slow if i > len(FAULTS) - 4 else ())
        for i, plant in enumerate(FAULTS.values())
    ],
    ids=FAULTS,
)
def test_a_fault_is_seen(example, plant):
    links = example.Links(CASE)
    plant(links)
    assert any(doubt.endswith(("disagree", "missing")) for doubt in doubts(links, CASE))


@pytest.mark.slow
def test_a_vibrissa_that_goes_through_the_object_has_not_let_go(example):
    """Free is also what it is behind the object; it must be clear of it, too."""
    links = example.Links(CASE, 10)
    sound = links.contact

    def blind():
        depth, *rest = sound()
        return (depth if links.foot_x > 0 else -1.0), *rest

    links.contact = blind
    found = sweep_stepping(CASE, lambda _: links, "blind", {})
    assert found.snap_off is None
    assert not found.trusted[CASE.foot_x < 0].any()
