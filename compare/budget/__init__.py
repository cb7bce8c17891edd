"""What a disagreement is made of: each part measured by a controlled change of its own."""

from compare.budget.budget import Budget, Part, budget
from compare.budget.measure import measure_budget
from compare.budget.plan import controlled_changes

__all__ = ["Budget", "Part", "budget", "controlled_changes", "measure_budget"]
