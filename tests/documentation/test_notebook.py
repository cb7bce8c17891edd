"""The notebook runs, cell by cell, and what its cells end with can be shown."""

import ast
import json

import pytest

from tests.documentation.blocks import ROOT

NOTEBOOKS = sorted((ROOT / "docs" / "examples").rglob("*.ipynb"))
assert NOTEBOOKS


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_every_cell_runs(path, monkeypatch):
    import matplotlib

    monkeypatch.setattr("matplotlib.pyplot.show", lambda: None)
    matplotlib.use("Agg")
    names: dict[str, object] = {}
    shown = []
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] != "code":
            continue
        assert not cell["outputs"]
        tree = ast.parse("".join(cell["source"]))
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, str(path), "exec"), names)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), str(path), "eval"), names)
            shown += [value._repr_html_()] if hasattr(value, "_repr_html_") else []
    assert len(shown) == 4
    assert all("data:image/png" in one for one in shown)
