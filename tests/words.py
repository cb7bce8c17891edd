"""Words that an engineer of today would not use: ``python -m tests.words``.

Looks through all text that is kept: code, pages, templates, settings.
``python -m tests.words pages`` counts the words of each page.
"""

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
SUFFIXES = {".py", ".md", ".j2", ".css", ".toml", ".yaml", ".yml", ".cff", ".csv", ""}
BETTER = {
    r"told|tells?|telling": "reports, shows, states, determines, distinguishes",
    r"foretold|foretells?|foretelling": "predicts",
    r"mend(?:s|ed|ing)?": "fix",
    r"lest": "so that ... not",
    r"whither|thither|hither|whence|thence": "where, there, from where",
    r"of no account": "irrelevant",
    r"naught|nought": "nothing, zero",
    r"where(?:of|in|by|upon)|there(?:of|upon)|hitherto|henceforth|forthwith": "plainer words",
    r"betwixt|nigh|ere|unto|behold|beware": "between, near, before, to, see, take care",
}
# Not between letters; an underscore is no letter, so that names are looked through, too.
_BANNED = {re.compile(rf"(?<![A-Za-z])(?:{x})(?![A-Za-z])", re.I): y for x, y in BETTER.items()}

_ANY = re.compile(rf"(?<![a-z])(?:{'|'.join(BETTER)})(?![a-z])")  # in small letters

_NO_WORDS = re.compile(r"^```.*?^```$|<!--.*?-->|(?<=\])\([^)]*\)", re.M | re.S)
_NO_PAGES = ("CHANGELOG.md", "paper.md")
_LETTER = re.compile(r"\w")


def files() -> list[Path]:
    """All kept files of text but this one and the licence, whose words are not ours."""
    if (ROOT / ".git").exists():
        command = ["git", "ls-files"]
        done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
        listed = done.stdout.splitlines()
    else:  # as a release unpacks, with what was installed and made since in hidden folders
        found = (path.relative_to(ROOT) for path in ROOT.rglob("*"))
        listed = [str(path) for path in found if not re.match(r"\.(?!ci/)|dist/|runs/", str(path))]
    paths = [ROOT / name for name in listed if name not in ("LICENSE", "tests/words.py")]
    return [path for path in paths if path.suffix in SUFFIXES and path.is_file()]


def offences() -> list[str]:
    """File, line, word and what to write in its place."""
    found = []
    for path in files():
        text = path.read_text(encoding="utf-8")
        if not _ANY.search(text.lower()):  # a tenth of the time that line by line takes
            continue
        for number, line in enumerate(text.split("\n"), 1):
            for banned, better in _BANNED.items():
                found += [
                    f"{path.relative_to(ROOT)}:{number}: {hit}: {better}"
                    for hit in banned.findall(line)
                ]
    return found


def lengths() -> dict[str, int]:
    """Words of each page but the list of changes and the paper, without code and addresses."""
    pages = [path for path in files() if path.suffix == ".md" and path.name not in _NO_PAGES]
    found = {}
    for path in pages:
        text = _NO_WORDS.sub(" ", path.read_text(encoding="utf-8"))
        found[str(path.relative_to(ROOT))] = sum(map(bool, map(_LETTER.search, text.split())))
    return found


def room(line: str) -> str:
    """The folder that a line is about."""
    return str(Path(line.split(":")[0]).parent)


if __name__ == "__main__":
    if sys.argv[1:] == ["pages"]:
        counted = lengths()
        print("\n".join(f"{n:6d} {page}" for page, n in counted.items()))
        print(f"{sum(counted.values()):6d} in all")
        sys.exit()
    wanted = sys.argv[1] if len(sys.argv) > 1 else ""
    lines = [line for line in offences() if line.startswith(wanted)]
    print("\n".join(lines))
    for where, count in sorted(Counter(map(room, lines)).items()):
        print(f"{count:4d} {where}")
    print(f"{len(lines):4d} in all")
    sys.exit(bool(lines))
