"""MuJoCo models of one's own, spoilt; and the files of a rig with their description."""

import re
from functools import cache
from importlib.resources import files

from tests.fuzz.inputs.dice import Dice
from tests.fuzz.inputs.sound import good_csv
from tests.fuzz.inputs.trial import Trial

SHIPPED = ("cable", "mistakes", "sound-chain", "tapered-whisker", "tutorial-chain")
NONSENSE = (
    "0", "-1", "1e308", "nan", "inf", "", "x", "1 2", "1e-30", "0 0 0", "../x", "9" * 400,
)  # fmt: skip
OTHERS = (
    b"", b"{}", b"\xff\xfe<\x00", b"<mujoco/>", b"<mujoco><worldbody/></mujoco>",
    b"<robot name='r'><link name='l'/></robot>", b"<mujoco><include file='model.xml'/></mujoco>",
    b"<mujoco><asset><mesh file='no.stl'/></asset></mujoco>",
    b"<?xml version='1.0'?><!DOCTYPE a [<!ENTITY b 'b'>]><a>&b;</a>",
    b"<mujoco><worldbody>" + b"<body>" * 3000 + b"</body>" * 3000 + b"</worldbody></mujoco>",
)  # fmt: skip
RIG = """[beam]
length = "50 mm"
flexural_rigidity = "2e-6 N m^2"
radius = "0.25 mm"
[columns]
foot_x = { column = "foot_x", unit = "mm" }
force_x = { column = "force_x", unit = "mN", gain = 1.02 }
force_y = { column = "force_y", unit = "mN" }
moment_z = { column = "moment_z", unit = "mN mm" }
[passes]
free_before = "5 mm"
"""


@cache
def _shipped(name: str) -> str:
    return files("mujoco_models").joinpath("models", f"{name}.xml").read_text()


def model(dice: Dice) -> Trial:
    """A model whose attributes, elements or names are not what they should be."""
    text = _shipped(dice.pick(*SHIPPED))
    for _ in range(dice.rng.integers(1, 4)):
        found = [*re.finditer(r'(\w+)="([^"]*)"', text)]
        at = found[dice.below(len(found))]
        kept = text[: at.start()], text[at.end() :]
        new = dice.pick(f'{at[1]}="{dice.pick(*NONSENSE)}"', f'{at[1]}x="{at[2]}"', "")
        text = new.join(kept)
    content = text.encode()
    if dice.chance(0.2):
        content = dice.damaged(content)
    if dice.chance(0.15):
        content = dice.pick(*OTHERS)
    words = ["inspect", f"model.{dice.pick('xml', 'xml', 'xml', 'urdf', 'mjb', 'txt')}"]
    for option, usual in (("--foot", "follicle"), ("--force", "force"), ("--geoms", "whisker*")):
        if dice.chance(0.15):
            words += [option, dice.pick(usual, "nobody", "", "*", "[", "x" * 300)]
    return Trial("model", words, {words[1]: content})


def rig(dice: Dice) -> Trial:
    """A rig's files and what describes them, one of them spoilt."""
    text = RIG
    for _ in range(dice.rng.integers(0, 3)):
        line = dice.pick(*text.splitlines())
        key = line.split(" = ")[0]
        new = dice.pick("", f"{key} = {dice.value()}", f"x{line}", line + "\n" + line)
        text = text.replace(line, new, 1)
    content = dice.damaged(good_csv()) if dice.chance(0.5) else good_csv()
    where = dice.pick("data", "data/one.csv", "nowhere", ".", "rig.toml")
    sound = {"data/one.csv": content, "rig.toml": text.encode(errors="surrogateescape")}
    return Trial("rig", ["rig", where, "--rig", "rig.toml", "--out", "out"], sound)
