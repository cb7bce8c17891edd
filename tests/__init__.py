"""What every process of the tests inherits, set before any of them imports NumPy."""

import os
import sys

# A process a core is what there is: threads of BLAS would fight the other processes for the cores.
os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")

# Bytecode is kept, whatever this machine says: each worker and each command that a test starts
# would compile hundreds of files anew.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False
