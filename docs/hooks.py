"""The pages stay where the code is; here they are collected, with what they link to.

One page for each package lists its public names, from their docstrings.
"""

import re
from importlib import import_module
from inspect import isclass, isfunction
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parents[1]
PACKAGES = ("analytic", "mujoco_models", "engines", "compare")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add every page in the table of contents, the files it links to, and the API's pages."""
    for page in _pages(config.nav):
        if page.startswith("api/"):
            files.append(File.generated(config, page, content=_reference(Path(page).stem)))
            continue
        source = ROOT / page
        files.append(File.generated(config, page, abs_src_path=str(source)))
        for link in re.findall(r"\]\(([^)#:\s]+)\)", source.read_text(encoding="utf-8")):
            target = (source.parent / link).resolve()
            name = target.relative_to(ROOT).as_posix()
            if target.suffix != ".md" and files.get_file_from_path(name) is None:
                files.append(File.generated(config, name, abs_src_path=str(target)))
    return files


def _pages(nav: object) -> list[str]:
    if isinstance(nav, str):
        return [nav]
    entries = nav.values() if isinstance(nav, dict) else nav
    return [page for entry in entries for page in _pages(entry)]  # type: ignore[attr-defined]


def _reference(package: str) -> str:
    """What a package exports, each name where it is defined."""
    module = import_module(package)
    names = {name: getattr(module, name) for name in module.__all__}
    lines = [f"# {package}", "", module.__doc__ or "", ""]
    for name, thing in names.items():
        if not (isclass(thing) or isfunction(thing)):
            lines.append(f"- `{name}` = `{str(thing).replace('typing.', '')}`")
    for name, thing in names.items():
        if isclass(thing) or isfunction(thing):
            lines.append(f"\n::: {thing.__module__}.{name}")
    return "\n".join(lines)
