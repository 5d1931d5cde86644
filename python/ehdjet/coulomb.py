"""The Coulomb force on any charges."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core

Norm = Literal["moving", "global", "per-bead"]


def forces(x: ArrayLike, q: ArrayLike, solver: str = "direct", tolerance: float = 1e-6, *, norm: Norm = "global",
           moves: ArrayLike | None = None, threads: int | None = None) -> NDArray[np.float64]:
    """The Coulomb forces of point charges on each other.

    Arguments:
        x: positions (N, 3) [m]
        q: charges (N,) [C]
        solver: "direct" (exact, O(N^2)), "treecode", "fmm", or "auto", which takes the cheapest; see `solvers`
        tolerance: allowed relative error; the direct sum has only round-off errors
        norm: what the error is relative to. "global": \\|F\\| over all charges; "per-bead": for each charge the sum
            of the magnitudes of its pair forces; "moving": the root mean square force of the charges that move,
            without the strongest tenth
        moves: (N,) of bool, for "moving" only: which charges move; by default all
        threads: by default what OpenMP would take

    Returns:
        forces (N, 3) [N]. A pair at zero distance is skipped.

    Raises:
        InputError: for wrong shapes, numbers that are not finite, and a tolerance that the solver cannot keep

    Other Python threads run during the sum. It cannot be interrupted.
    """
    return _core.forces(x, q, solver, tolerance, norm, moves, checked_threads(threads))


def force_error(x: ArrayLike, q: ArrayLike, force: ArrayLike, *, norm: Norm = "global", targets: int = 2000,
                moves: ArrayLike | None = None) -> float:
    """The error of Coulomb forces, in a norm of `forces` [-].

    Up to `targets` evenly spaced charges are compared with a direct sum in long double.

    Arguments:
        x, q, norm, moves: as for `forces`
        force: forces (N, 3) [N], of these charges only
    """
    return _core.force_error(x, q, force, norm, targets, moves)


def solvers() -> dict[str, str]:
    """Names and descriptions of the solvers."""
    return _core.solvers()


def checked_threads(threads: int | None) -> int | None:
    """errors: InputError for a number of threads out of range"""
    from .errors import InputError

    if threads is not None and not 1 <= threads <= 4096:
        raise InputError(f"threads = {threads}: must be from 1 to 4096, or None")
    return threads
