from .beams.available import available_beams as available_beams
from .errors import ClampError as ClampError
from .errors import DivergedError as DivergedError
from .settings import Settings as Settings
from .simulate import load_tip as load_tip
from .simulate import simulate_sweep as simulate_sweep
from .simulate import view_sweep as view_sweep
