"""All code and commands of all pages are run unless a block says why not; links lead somewhere."""

import contextlib
import doctest
import io
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any, get_args, get_type_hints

import pytest
import typer

from compare.commands.main import app
from compare.read.tables import CaseFile
from tests.compare.command import Done, vibrissa
from tests.documentation.blocks import PAGES, ROOT, Block, blocks
from tests.fuzz.mistakes import MISTAKES

WITH_CODE = [page for page in PAGES if any(block.runs for block in blocks(page))]
BIN = Path(sys.executable).parent
IDS = {"ids": str}
_OF_MAKE = ("MAKE", "MFLAGS", "ARGS", "CASE")  # what `make test-all ARGS=...` hands on


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """A user's folder: `make` there is this project's, with the Python that runs the tests."""
    monkeypatch.setenv("COLUMNS", "120")
    tools = tmp_path / "bin"
    tools.mkdir()
    make = tools / "make"
    make.write_text(
        f'#!/bin/sh\nexec /usr/bin/make -s -f "{ROOT}/Makefile" BIN="{BIN}" BIN_MUJOCO3="{BIN}" '
        '-o .venv/installed -o .venv/developed -o .venv-mujoco3/installed "$@"\n'
    )
    make.chmod(0o755)
    activate = tmp_path / "work" / ".venv" / "bin" / "activate"  # the tests' Python is active
    activate.parent.mkdir(parents=True)
    activate.touch()
    return tmp_path / "work"


def run(some: Iterable[Block], folder: Path) -> None:
    """Run blocks in one folder and one session of Python, in their order; check what they print."""
    names: dict[str, Any] = {"__name__": "__main__"}
    for block in some:
        if block.file:
            (folder / block.file).write_text(block.text)
        if not block.runs:
            continue
        done = _commands(block, folder) if block.language == "sh" else _python(block, folder, names)
        assert done.returncode == 0, f"{block}\n{done.stdout}{done.stderr}"
        if block.prints is not None:
            matches = doctest.OutputChecker().check_output
            flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
            assert matches(block.prints, done.stdout, flags), f"{block} prints\n{done.stdout}"


def _python(block: Block, folder: Path, names: dict[str, Any]) -> Done:
    """In this process: a fresh one would take longer to import than most blocks to run."""
    out = io.StringIO()
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(out):
        patch.chdir(folder)
        patch.syspath_prepend(folder)
        exec(compile(block.text, str(block), "exec"), names)
    return Done(0, out.getvalue(), "")


def _commands(block: Block, folder: Path) -> Done:
    """In this process if all are ours, up to the first that fails; else by a shell, as users do."""
    lines = block.text.replace("\\\n", " ").splitlines()
    commands = [shlex.split(line, comments=True) for line in lines]
    if any(command[0] != "vibrissa" or "||" in command for command in commands):
        return _shell(block, folder)
    said = ["", ""]
    for _, *words in commands:
        done = vibrissa(*words, cwd=folder)
        said = [said[0] + done.stdout, said[1] + done.stderr]
        if done.returncode != 0:
            break
    return Done(done.returncode, *said)


def _shell(block: Block, folder: Path) -> Done:
    path = f"{folder.parent / 'bin'}:{BIN}:{os.environ['PATH']}"
    plain = {k: v for k, v in os.environ.items() if not k.startswith(_OF_MAKE)}
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", block.text],
        cwd=folder,
        env=plain | {"PATH": path, "PYTHONPATH": f"{folder}:{ROOT}"},
        capture_output=True,
        text=True,
        check=False,
    )
    return Done(done.returncode, done.stdout, done.stderr)


def test_quick_blocks_of_the_front_page(folder):
    run([block for block in blocks(Path("README.md")) if not block.slow], folder)


@pytest.mark.slow
@pytest.mark.parametrize("page", WITH_CODE, **IDS)
def test_the_whole_page(page, folder):
    run(blocks(page), folder)


def _named(page: Path) -> list[str]:
    """Every command in the page's text and blocks, up to the end of the line or the back quote."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return re.findall(r"(?:^|`|\$ |/)((?:vibrissa|make)\b[^`\n#|]*)", text, re.M)


@pytest.mark.parametrize("page", PAGES, **IDS)
def test_commands_and_options_exist(page):
    group: Any = typer.main.get_command(app)
    targets = set(re.findall(r"^([a-z0-9-]+):", (ROOT / "Makefile").read_text(), re.M))
    for command in _named(page):
        words = command.split()
        if words[0] == "make":
            asked = [w for w in words[1:] if "=" not in w and not w.endswith('"')]
            assert set(asked) <= targets, command
        elif len(words) > 1 and re.fullmatch("[a-z][a-z-]*", words[1]):
            known = group.get_command(None, words[1])
            assert known is not None, command
            options = {name for option in known.params for name in option.opts} | {"--help"}
            used = {w.split("=")[0] for w in words[2:] if re.match(r"\[?--?[a-z]", w)}
            assert {w.strip("[]") for w in used} <= options, command


@pytest.mark.parametrize("page", PAGES, **IDS)
def test_links_lead_to_files_and_to_their_headings(page):
    links = re.findall(r"\]\(([^)\s#]*)(?:#([^)\s]+))?", _without_code(page))
    ours = [(page.parent / name if name else page, at) for name, at in links if "://" not in name]
    assert not [name for name, _ in ours if not (ROOT / name).exists()]
    assert not [(name, at) for name, at in ours if at and at not in _anchors(name)]


def _without_code(page: Path) -> str:
    return re.sub(r"```.*?```", "", (ROOT / page).read_text(encoding="utf-8"), flags=re.S)


def _anchors(page: Path) -> set[str]:
    """What the headings of a page are called in links."""
    headings = re.findall(r"^#+ (.*)", _without_code(page), re.M)
    return {re.sub(r"[^\w\- ]", "", one.lower()).replace(" ", "-") for one in headings}


def test_every_kind_of_contour_and_its_keys_are_described():
    page = (ROOT / "analytic" / "case-file.md").read_text(encoding="utf-8")
    (kinds, *_) = get_args(get_type_hints(CaseFile, include_extras=True)["profile"])
    for table in get_args(kinds):
        keys = set(table.model_fields) - {"kind", "scale"}
        for kind in get_args(table.model_fields["kind"].annotation):
            (row,) = re.findall(rf"^\| `{kind}` \|.*", page, re.M)
            assert keys <= set(re.findall(r"\w+", row)), row


def test_pages_say_the_same_of_planted_mistakes():
    """As ``python -m tests.fuzz.mistakes 7`` prints it; a new mistake makes what they say old."""
    said = r"Of (\d+) (?:such )?mistakes .*?(\d+) % .*?named rightly and ([\d.]+) % wrongly"
    pages = [ROOT / "compare" / "gates.md", ROOT / "docs" / "release" / "paper.md"]
    of_gates, of_paper = (re.search(said, page.read_text(), re.I | re.S) for page in pages)
    assert of_gates.groups() == of_paper.groups()
    assert int(of_gates[1]) == 7 * sum(mistake.must for mistake in MISTAKES.values())


def test_blocks_are_in_a_language_that_is_run_or_say_why_not():
    known = {"", "python", "sh", "toml"}
    odd = [b for page in PAGES for b in blocks(page) if b.language not in known]
    assert not [str(b) for b in odd if not (b.language == "xml" and b.note)]
