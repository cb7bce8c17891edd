"""What a release states in several places is the same in all of them."""

import json
import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
RECIPE = (ROOT / "docs" / "release" / "recipe.yaml").read_text(encoding="utf-8")
CITATION = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
CALLED = {"matplotlib": "matplotlib-base", "mujoco": "mujoco-python"}  # by conda


def test_version_and_licence():
    assert f'version: "{PROJECT["version"]}"' in RECIPE
    assert f"version: {PROJECT['version']}\n" in CITATION
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert re.search(r"^## (.*)", changes, re.M)[1] == PROJECT["version"]
    assert f"license: {PROJECT['license']}\n" in CITATION
    assert f"license: {PROJECT['license']}\n" in RECIPE


def test_conda_installs_what_pip_does():
    wanted = set()
    for one in PROJECT["dependencies"]:
        name, limits = re.fullmatch(r"([a-z0-9-]+)(.*)", one).groups()
        wanted.add(f"    - {CALLED.get(name, name)} {limits}\n")
    run = RECIPE[RECIPE.index("  run:\n") : RECIPE.index("tests:")]
    listed = set(run.splitlines(keepends=True)) - {"  run:\n", "\n"}
    assert listed == wanted | {f"    - python {PROJECT['requires-python']}\n"}


def test_the_developers_are_called_the_same():
    (author,) = PROJECT["authors"]
    zenodo = json.loads((ROOT / ".zenodo.json").read_text(encoding="utf-8"))
    assert zenodo["creators"] == [author]
    assert f"- name: {author['name']}\n" in CITATION
    assert zenodo["license"] == PROJECT["license"]


def test_the_paper_cites_what_it_lists():
    folder = ROOT / "docs" / "release"
    cited = set(re.findall(r"@(\w+)", (folder / "paper.md").read_text(encoding="utf-8")))
    assert cited == set(re.findall(r"^@\w+{(\w+),", (folder / "paper.bib").read_text(), re.M))
