"""The pictures of the gallery: ``python -m docs.gallery.make`` runs the page's blocks beside it."""

import os
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

from tests.documentation.blocks import ROOT, blocks

PAGE = Path("docs/gallery/README.md")
_COLOURS = 64  # that a picture keeps, which makes it a third as large


def main() -> None:
    """Run the blocks in a folder of their own, and keep the pictures."""
    names: dict[str, object] = {}
    with TemporaryDirectory() as folder:
        os.chdir(folder)
        for block in blocks(PAGE):
            exec(compile(block.text, str(block), "exec"), names)
        for file in sorted(Path(folder).glob("*.png")):
            with Image.open(file) as picture:
                few = picture.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
            few.save(ROOT / PAGE.parent / file.name, optimize=True)
        os.chdir(ROOT)


if __name__ == "__main__":
    main()
