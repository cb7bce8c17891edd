"""What ``run`` is to do beside its sweeps."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from compare.align.frames import Frame
    from compare.show.document import Film

Draw = Callable[[Path, int, Callable[[], None]], object]
"""Draws a film into a folder, of so many frames, and says when one is done."""


@dataclass(frozen=True)
class Asked:
    """What the command line asks for."""

    sweep_only: bool = False
    budget: bool = False
    target: float | None = None
    frames: int | None = None  # of a film; None for no film
    figures: bool = False
    certified: bool = False
    frame: "Frame" = "world"  # of the components in space

    def film(self, draw: Draw, folder: Path) -> "Film | None":
        """The film, if there is to be one; an older one would be of other sweeps."""
        from compare.commands.terminal import progress
        from compare.show.document import Film

        if self.frames is None:
            (folder / "animation.gif").unlink(missing_ok=True)
            return None
        with progress("frames", self.frames) as advance:
            draw(folder, self.frames, advance)
        return Film.of(folder)
