"""How large each room is, in lines of code, docstring and all: ``python -m tests.size``."""

import ast
import tokenize
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
PRODUCT = ("analytic", "mujoco_models", "engines", "compare", "pytest_vibrissa.py")
DEPTH = 2  # folders that a room is named by


def count(path: Path) -> Counter[str]:
    """Lines of a file: all, those with code, those of docstrings."""
    text = path.read_text(encoding="utf-8")
    docstrings: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        value = node.value if isinstance(node, ast.Expr) else None
        if isinstance(value, ast.Constant) and isinstance(value.value, str):
            docstrings.update(range(value.lineno, (value.end_lineno or value.lineno) + 1))
    spare = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT}
    code: set[int] = set()
    with path.open("rb") as file:
        for token in tokenize.tokenize(file.readline):
            if token.type not in spare | {tokenize.ENCODING, tokenize.ENDMARKER}:
                code.update(range(token.start[0], token.end[0] + 1))
    return Counter(
        lines=text.count("\n"), code=len(code - docstrings), docstring=len(docstrings), files=1
    )


def rooms(names: tuple[str, ...]) -> dict[str, Counter[str]]:
    """What each folder, down to a depth of two, holds."""
    found: dict[str, Counter[str]] = {}
    for top in (ROOT / name for name in names):
        for path in [top] if top.is_file() else sorted(top.rglob("*.py")):
            room = "/".join(path.relative_to(ROOT).parts[:-1][:DEPTH]) or path.name
            found[room] = found.get(room, Counter()) + count(path)
    return found


if __name__ == "__main__":
    print(f"{'':28}{'lines':>8}{'code':>8}{'docs':>8}{'files':>7}")
    for title, names in (("product", PRODUCT), ("tests", ("tests",))):
        table = rooms(names)
        total: Counter[str] = sum(table.values(), Counter())
        for room, size in [*sorted(table.items()), (f"{title}, all", total)]:
            print(
                f"{room:28}{size['lines']:8,}{size['code']:8,}"
                f"{size['docstring']:8,}{size['files']:7,}"
            )
        print()
