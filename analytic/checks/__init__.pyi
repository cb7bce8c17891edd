from .paper import boundary_value_problem as boundary_value_problem
from .paper import tip_angle_by_quadrature as tip_angle_by_quadrature
from .paper import tip_angle_by_shooting as tip_angle_by_shooting
