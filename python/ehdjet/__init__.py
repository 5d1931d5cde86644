"""Electrospinning: electrically charged viscoelastic jets as chains of beads.

    >>> import ehdjet
    >>> scene = ehdjet.Scene("scenes/quickstart.toml")
    >>> scene["run.end_time"] = 2e-3
    >>> run = ehdjet.run(scene, "quickstart.h5")
    >>> run.observables["tip_x"].plot()

All quantities are in SI units. docs/python.md tells more.
"""

import os as _os

# Idle threads of the OpenMP runtime of GCC spin for milliseconds unless they are told not to, before they are loaded.
_bound_waiting = not {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT"} & _os.environ.keys()
if _bound_waiting:
    _os.environ["GOMP_SPINCOUNT"] = "1000"
try:
    from . import _core
finally:
    if _bound_waiting:
        del _os.environ["GOMP_SPINCOUNT"]

from ._core import Jet
from .coulomb import force_error, forces, solvers
from .errors import ContractViolation, InputError, RunError
from .run_file import Run, open_run
from .running import Advance, Simulation, run
from .scene import Scene, key_reference

#: Version, commit, compiler, instruction set and threads of the library, by name.
build = _core.build_environment()
__version__ = build["version"]

__all__ = [
    "Advance", "ContractViolation", "InputError", "Jet", "Run", "RunError", "Scene", "Simulation", "build",
    "force_error", "forces", "key_reference", "open_run", "run", "solvers",
]
