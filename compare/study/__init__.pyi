from .grid.file import load_study as load_study
from .grid.plan import Plan as Plan
from .grid.study import Study as Study
from .keep.store import read_rows as read_rows
