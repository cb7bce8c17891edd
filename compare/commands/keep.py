"""What a command writes, each file whole, and said in a line."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from analytic.problem.files import write_whole
from compare.commands.terminal import print_written
from compare.show.page import document, save_figure


def keep(path: Path, content: str | bytes | Mapping[str, Any] | pd.DataFrame | Figure) -> None:
    """Write a text, a JSON file of numbers by name, a table as CSV, or a picture."""
    match content:
        case Figure():
            print_written(save_figure(content, path))
        case pd.DataFrame():
            print_written(write_whole(path, content.to_csv(index=False)))
        case str() | bytes():
            print_written(write_whole(path, content))
        case _:
            print_written(write_whole(path, document(content)))
