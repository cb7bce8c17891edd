"""A user's own model swept past the case's object."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import Beam, Case, InputError, Sweep, circle, named_case, solve_sweep
from compare import compare
from mujoco_models import (
    DivergedError,
    Motion,
    OwnModel,
    Settings,
    inspect_model,
    shipped_models,
    simulate_model,
)
from tests.mujoco_models.inspect.chains import Chain

STEEL = Case(Beam(0.1, 6.44e-4, 2.5e-4), circle(0.08, (0, 0.04)), Sweep(40), "steel")
UNIT = Case(Beam(), circle(0.8, (0, 0.4)), Sweep(40), "unit")
COARSE = Settings(contour_points=400)
FAST = Motion(speed=0.2)


def swept(tmp_path, chain, *changes, case=UNIT, **names):
    return simulate_model(case, OwnModel(chain.write(tmp_path, *changes), **names), FAST, COARSE)


def worst(case, moved):
    return max(d.rms for d in compare(solve_sweep(case), moved).disagreement.values())


def test_a_sound_model_agrees_with_the_closed_form():
    """In metres and newtons; what is left is twenty links, the contact and the speed."""
    own = OwnModel(shipped_models()["sound-chain"])
    moved = simulate_model(STEEL, own, Motion(speed=0.1), COARSE)
    assert worst(STEEL, moved) < 6e-3
    # Three bounce after the first contact, each losing it once; one at the release.
    assert (moved.table["status"] != "ok").sum() <= 4
    # Where it touches is known far better than to a link.
    exact = solve_sweep(STEEL)
    off = moved.values("contact_arc_length") - exact.values("contact_arc_length")
    assert np.nanmax(np.abs(off[exact.table["phase"] == "tangent"])) < 0.2 * 0.1 / 20


def test_default_contacts_are_found_wanting_and_inspect_said_so():
    own = OwnModel(shipped_models()["tutorial-chain"])
    moved = simulate_model(STEEL, own, Motion(speed=0.1), COARSE)
    assert worst(STEEL, moved) > 0.1
    assert moved.values("penetration").max() > 2 * 2.5e-4


OURS = {"contact": "ours"}
RAIL = '<joint name="rail" type="slide" axis="1 0 0" armature="10"/>'
ON_RAIL = Chain(foot="", inside_foot=RAIL)


def driven(actuator):
    return "</mujoco>", f"<actuator>{actuator}</actuator></mujoco>"


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """The sweep of a sound chain, to hold others against."""
    return swept(tmp_path_factory.mktemp("plain"), Chain(), **OURS)


@pytest.mark.slow
def test_a_mocap_foot_has_no_speed_and_chatters(tmp_path):
    """Observed: 14 of 60 stations, against 5 on a slide; `inspect` says so."""
    sound = shipped_models()["sound-chain"]
    text, mocap = sound.read_text(), tmp_path / "mocap.xml"
    rail = '<body name="foot">\n      <joint name="rail" type="slide" axis="1 0 0" armature="10"/>'
    assert rail in text
    head, _, tail = text.replace(rail, '<body name="foot" mocap="true">').partition("<actuator>")
    mocap.write_text(head + tail.partition("</actuator>")[2])
    case = replace(STEEL, sweep=Sweep(60))
    chattering = [
        (simulate_model(case, OwnModel(p), Motion(speed=0.1), COARSE).table["status"] != "ok").sum()
        for p in (sound, mocap)
    ]
    assert chattering[0] <= 5
    assert chattering[1] > 8


@pytest.mark.slow
def test_the_clamp_is_read_in_whatever_frame_the_sensor_has(tmp_path, plain):
    """A turned site, off the clamp: the readings are carried to the clamp and turned back."""
    other = swept(tmp_path, Chain(site='euler="0.3 -0.4 0.5" pos="0.01 -0.1 0"'), **OURS)
    for name in ("force_x", "force_y", "moment_z"):
        assert other.values(name) == pytest.approx(plain.values(name), abs=1e-8)


def test_a_heavy_foot_is_not_felt(tmp_path, plain):
    """Its sensors feel 1 kg of it, too, were it accelerated: 9 % of a force with this armature."""
    inertial = '<inertial pos="0 0 0" mass="1000" diaginertia="1 1 1"/>'
    slide = '<joint name="rail" type="slide" axis="1 0 0" armature="10000"/>'
    heavy = swept(tmp_path, Chain(foot="", inside_foot=slide + inertial), **OURS)
    scale = np.abs(plain.values("force_x")).max()
    off = (heavy.values("force_x") - plain.values("force_x"))[5:15] / scale
    assert np.sqrt(np.mean(off**2)) < 0.02


@pytest.mark.parametrize(
    "chain",
    [
        Chain(beside='<geom type="sphere" size="0.05" pos="-0.3 0.2 0"/>'),
        Chain(foot="", inside_foot=f'{RAIL}<geom fromto="-0.1 0 0 -0.1 0.6 0" mass="1"/>'),
    ],
    ids=["post", "bar"],
)
def test_a_station_that_touches_another_thing_says_so(tmp_path, plain, chain):
    """A post on the way, which the vibrissa meets; a bar on the foot, which meets the object."""
    found = swept(tmp_path, chain, **OURS).table
    assert "touches another" not in set(plain.table["status"])
    other = (found["status"] == "touches another").to_numpy()
    first = int(np.argmax(other))
    assert first > 1  # a foot on a slide bounces at the first contact
    assert other[first : first + 10].all()


@pytest.mark.slow
def test_another_vibrissa_that_the_sensors_do_not_feel_is_no_other_thing(tmp_path):
    """Two on one carriage, each on a body of its own: the object meets the other one, too."""
    path = Chain(foot="").write(tmp_path)
    other = Chain(foot='pos="0 0 0.2"').text("other").replace('name="clamp"', "")
    weight = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
    head, foot, tail = path.read_text().partition('<body name="whisker-foot" >')
    text = f'{head}<body name="carriage">{RAIL}{weight}{other}{foot}{tail}'
    path.write_text(text.replace("</worldbody>", "</body></worldbody>"))
    own = OwnModel(path, foot="whisker-foot", **OURS)
    found = simulate_model(UNIT, own, FAST, COARSE).table
    assert "touches another" not in set(found["status"])


@pytest.mark.slow
def test_sensors_are_added_at_a_site(tmp_path, plain):
    """In memory, and they read what the model's own ones there would."""
    without = Chain(sensors="").write(tmp_path)
    before = without.read_bytes()
    found = inspect_model(without, site="clamp")
    assert found.force.lever == pytest.approx([0, 0, 0], abs=1e-9)
    added = simulate_model(UNIT, OwnModel(without, site="clamp", **OURS), FAST, COARSE)
    for name in ("force_x", "force_y", "moment_z"):
        assert added.values(name) == pytest.approx(plain.values(name), abs=1e-12)
    assert without.read_bytes() == before
    with pytest.raises(InputError, match=r"^--site = 'klamp'.*it has clamp$"):
        inspect_model(without, site="klamp")


def test_a_vibrissa_of_30_mm_is_as_good_as_one_of_a_metre(tmp_path, plain):
    """In metres its object is so small that MuJoCo would refuse the volume of a part of it."""
    unit, small = Beam(), 0.03
    rigidity = small**3  # the same mass and period
    beam = Beam(small, rigidity, unit.radius * small)
    case = replace(UNIT, beam=beam, profile=circle(0.8 * small, (0, 0.4 * small)))
    chain = Chain(length=small, rigidity=rigidity, radius=beam.radius)
    found = swept(tmp_path, chain, case=case, **OURS)
    scale = beam.force_unit / unit.force_unit
    off = found.values("force_y") / scale - plain.values("force_y")
    # Vertices are kept in single precision, and facets amplify that.
    assert np.abs(off)[5:15].max() < 2e-2 * np.abs(plain.values("force_y")).max()


@pytest.mark.slow
def test_wherever_the_vibrissa_stands_and_points(tmp_path, plain):
    # Along x, its hinges along z: the sweep goes along y.
    turned = Chain(foot='mocap="true" pos="3 -2 1" euler="0 0 -1.5707963267948966"')
    other = swept(tmp_path, turned, **OURS)
    # The mesh is stored in single precision, and a contact on facets amplifies that.
    assert other.values("force_y")[5:15] == pytest.approx(plain.values("force_y")[5:15], abs=2e-2)


@pytest.mark.parametrize(
    ("joint", "actuator"),
    [
        ("", ""),
        pytest.param('damping="0"', '<velocity joint="rail" kv="1e5"/>', marks=pytest.mark.slow),
        ('damping="1e3"', '<position joint="rail" kp="1e6" kv="1e4"/>'),
    ],
)
@pytest.mark.parametrize("sense", ["-1 0 0", pytest.param("1 0 0", marks=pytest.mark.slow)])
def test_a_foot_on_a_slide_is_driven_as_the_model_has_it(tmp_path, plain, joint, actuator, sense):
    slide = RAIL.replace("1 0 0", sense).replace("/>", f" {joint}/>")
    other = swept(tmp_path, Chain(foot="", inside_foot=slide), driven(actuator), **OURS)
    scale = np.abs(plain.values("force_y")).max()
    both = (plain.table["phase"] == other.table["phase"]) & plain.trusted & other.trusted
    both = both.to_numpy()
    assert both.sum() > 20
    off = (other.values("force_y") - plain.values("force_y"))[both] / scale
    assert np.sqrt(np.mean(off**2)) < 0.02


@pytest.mark.slow
@pytest.mark.parametrize(
    ("timestep", "integrator", "nominal"),
    [(0.02, "discrete", 9.4), (0.005, "discrete", 4.5), (5e-4, "implicitfast", 1.0)],
)
def test_inspect_knows_how_stiff_contacts_are(tmp_path, timestep, integrator, nominal):
    """At the tip, against what a slow sweep sinks in: `discrete` makes solref up to 9 times harder.

    Observed 0.63, 0.64, 0.99 of it. The tip is touched by its end and aslant, and is measured
    across and in the middle of the last link.
    """
    path = replace(ON_RAIL, links=30).write(
        tmp_path,
        driven('<velocity joint="rail" kv="1e5"/>'),
        ('solref="0.02 1" solimp="0.98 0.98 0.001"', 'solref="0.04 1" solimp="0.99 0.99 0.001"'),
        (
            'timestep="0.01" integrator="discrete"',
            f'timestep="{timestep}" integrator="{integrator}"',
        ),
    )
    case = replace(named_case("tip-only"), sweep=Sweep(4, 1.28, 1.16))  # touched at 1.26
    moved = simulate_model(case, OwnModel(path), Motion(speed=0.02), COARSE)
    force = np.hypot(moved.values("force_x_raw"), moved.values("force_y_raw"))[-1]
    stiffness = force / moved.values("penetration")[-1]
    assert 0.5 < inspect_model(path).geoms[-1].stiffness / stiffness < 1.05
    assert stiffness / 1340 == pytest.approx(nominal, rel=0.15)


def test_files_are_left_alone(tmp_path):
    path = Chain().write(tmp_path)
    before = path.read_bytes(), path.stat().st_mtime_ns
    inspect_model(path)
    simulate_model(UNIT, OwnModel(str(path), contact="ours"), FAST, COARSE)
    assert (path.read_bytes(), path.stat().st_mtime_ns) == before
    assert [*tmp_path.iterdir()] == [path]


@pytest.mark.parametrize(
    ("chain", "names", "said"),
    [
        (Chain(length=1000.0, radius=5.0), {}, "is the model in millimetres"),
        (Chain(length=1.3), {}, "state the model's own length"),
        (Chain(foot="", inside_foot='<joint type="slide" axis="0 0 1"/>'), {}, "can be moved"),
        (Chain(foot="", inside_foot="<freejoint/>"), {}, "weld it to a mocap body"),
        (Chain(sensors='<force name="F" site="clamp"/>'), {}, "torque sensor .* missing"),
        (Chain(foot=""), {}, "touch|can be moved|exclude"),
        (Chain(), {"foot": "hand"}, "foot of the model = 'hand'"),
        (Chain(rigidity=1e4), {}, "^time step of the model = 0.01, 1 of .* at most 0.000999"),
    ],
)
def test_what_is_wrong_is_one_line(tmp_path, chain, names, said):
    with pytest.raises(InputError, match=said) as caught:
        swept(tmp_path, chain, **names)
    assert "\n" not in str(caught.value)


_NOTHING = 'contype="2" conaffinity="2"'
_LINKS = [f'<geom name="whisker-geom{i}"' for i in (1, 2, 3, 4)]


@pytest.mark.parametrize(
    "changes",
    [
        [("<geom type", f"<geom {_NOTHING} type")],
        # All but the piece that is fixed to the foot.
        [(link, link.replace("<geom", f"<geom {_NOTHING}")) for link in _LINKS],
        [("</mujoco>", '<option><flag contact="disable"/></option></mujoco>')],
    ],
)
def test_geoms_that_meet_nothing(tmp_path, changes):
    with pytest.raises(InputError, match="meet nothing"):
        swept(tmp_path, Chain(links=4), *changes)


@pytest.mark.parametrize(
    ("actuator", "said"),
    [
        ('<motor name="push" joint="rail"/>', "a force keeps no speed"),
        ('<velocity joint="rail" kv="1e-3"/>', "follows its drive"),
    ],
)
def test_a_force_is_no_drive_and_a_weak_one_is_noticed(tmp_path, actuator, said):
    with pytest.raises(InputError, match=said):
        swept(tmp_path, ON_RAIL, driven(actuator))


def test_springs_that_are_too_stiff_for_the_step_are_reported(tmp_path):
    explicit = 'timestep="0.01" integrator="discrete"', 'timestep="0.03" integrator="Euler"'
    with pytest.raises(DivergedError, match="shorten the time step"):
        swept(tmp_path, Chain(), explicit, **OURS)
