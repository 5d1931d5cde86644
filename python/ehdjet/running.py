"""Runs: into a file, or step by step."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Advance, Jet
from .coulomb import checked_threads
from .errors import InputError
from .run_file import Run
from .scene import Scene

#: (jet) -> forces (N, 3) [N]
Force = Callable[[Jet], NDArray[np.float64]]
#: Called at the end of each step; or with an interval [s]: at its multiples, the ends included.
Observer = Union[Callable[[Jet], Any], tuple[float, Callable[[Jet], Any]]]
#: True shows a line on standard error; a function is called with an `Advance` some twenty times per second.
Progress = Union[bool, Callable[[Advance], Any], None]
Forces = Union[Mapping[str, Force], Iterable[Force]]


def expect_scene(scene: Any) -> None:
    if not isinstance(scene, Scene):
        raise TypeError(f"a run needs an ehdjet.Scene, not a {type(scene).__name__}: "
                        "ehdjet.Scene(...) makes one of a file or of tables")


def run(scene: Scene, output: str | os.PathLike[str], *, overwrite: bool = False, threads: int | None = None,
        continue_from: str | os.PathLike[str] | None = None, forces: Forces = (), observers: Iterable[Observer] = (),
        progress: Progress = None) -> Run:
    """Simulates a scene into a run file, like ``ehdjet run``: with the same bits for the same number of threads.

    Arguments:
        scene: also of an array of jets, then without own forces and observers
        output: the run file (HDF5)
        overwrite: an existing file of that name is overwritten; by default it is an error
        threads: by default those of the scene, or else what OpenMP would take
        continue_from: a run file of the same scene. The run goes on from its last checkpoint; only run.end_time,
            run.max_wall_time and [output] may differ
        forces: own terms of the equations of motion, as for `Simulation`
        observers: functions that see the jet, as for `Simulation`
        progress: True, or a function of an `Advance`. A function that raises stops the run between two steps

    Returns:
        the run file, opened

    Raises:
        InputError: before the first step, if the scene cannot be built or the file cannot be created
        RunError: if the run fails. The file has everything up to then
        KeyboardInterrupt: after Ctrl-C, at the end of the step. The file has everything up to then and the status
            "interrupted"
        what a force or observer raises. The file has everything up to then and the status "failed"

    Other Python threads run meanwhile. Notes of an exception (`__notes__`) say what the file has.
    """
    expect_scene(scene)
    if not overwrite and os.path.exists(output):
        raise InputError(f"{output} exists: choose another name, or overwrite it with overwrite=True")
    if scene._core.has_array and (forces or observers):
        raise InputError("[array] cannot be used with own forces or observers: they are those of a single jet")
    names, functions = named_forces(forces)
    intervals, observing = timed_observers(observers)
    with shown(progress) as show:
        _core.run(scene._core, output, overwrite, checked_threads(threads), continue_from, scene.file, names,
                  functions, intervals, observing, show)
    return Run(output)


class Simulation:
    """A jet whose steps are in the caller's hands. Nothing is written to files.

    Arguments:
        scene: of a single jet
        forces: own terms of the equations of motion: functions ``force(jet) -> (N, 3)`` [N], or a mapping of names
            to them. Messages name them. The jet is that of one stage of a step, and N counts all beads,
            the nozzle included (row 0). A force may depend on ``jet.time``, position, velocity and every other column,
            and on nothing else: a step may be attempted again
        observers: functions ``observe(jet)``, called at the end of each step, or pairs ``(interval, observe)``, called at
            multiples of the interval [s], start and end included. They change nothing, and times between the ends of
            steps come from the dense output of the step
        threads: by default those of the scene, or else what OpenMP would take

    Own forces switch two rates off (integrator.method = "auto" then takes one).

    Raises:
        InputError: if the scene has [array], or if it cannot be built
    """

    def __init__(self, scene: Scene, *, forces: Forces = (), observers: Iterable[Observer] = (),
                 threads: int | None = None) -> None:
        expect_scene(scene)
        if scene._core.has_array:
            raise InputError("Simulation is of a single jet, and the scene has [array]: take ehdjet.run")
        self._scene = scene.copy()
        # These lists own the functions; the compiled half borrows them during a step.
        names, self._forces = named_forces(forces)
        intervals, self._observers = timed_observers(observers)
        self._core = _core.Simulation(self._scene._core, checked_threads(threads), names, intervals)

    @property
    def scene(self) -> Scene:
        """A copy of the scene as it was when the simulation was made."""
        return self._scene.copy()

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._core.time

    @property
    def jet(self) -> Jet:
        """The jet now. Its arrays are read-only views of the simulation's columns, not copies. They stay valid, and show
        the jet of this moment, also after the next step and after the simulation is gone: whoever goes on while
        views exist pays for one copy of the jet."""
        return self._core.jet

    @property
    def statistics(self) -> dict[str, Any]:
        """Cost so far: evaluations, steps, rejected, insertions, landings, wall_time [s], ..."""
        return self._core.statistics

    @property
    def ledger(self) -> dict[str, float]:
        """What has entered and left the jet: inserted_mass [kg], removed_charge [C], ..."""
        return self._core.ledger

    def run_until(self, end_time: float | None = None, *, progress: Progress = None) -> None:
        """Runs to a time [s], by default the scene's run.end_time. Does nothing if the jet is there already.

        Raises:
            RunError: if the run fails; the simulation cannot go on, `jet` stays readable
            KeyboardInterrupt: after Ctrl-C, at the end of the step; the simulation can go on
            what a force or observer raises; the simulation cannot go on
        """
        with shown(progress) as show:
            self._core.run_until(self._end(end_time), self._forces, self._observers, show)

    def step(self, end_time: float | None = None) -> bool:
        """One step towards a time [s], by default the scene's run.end_time.

        The steps are those of ``run_until(end_time)``, bit for bit. False, without a step, if the jet is there
        already.
        """
        return self._core.step(self._end(end_time), self._forces, self._observers)

    def _end(self, end_time: float | None) -> float:
        if end_time is None:
            return self._scene._core.end_time
        if not np.isfinite(end_time):
            raise InputError(f"end_time = {end_time} s: must be finite")
        return end_time

    def __repr__(self) -> str:
        return f"<ehdjet.Simulation at t = {self.time:.9g} s of {self._scene!r}>"


def named_forces(forces: Forces) -> tuple[list[str], list[Force]]:
    if not isinstance(forces, Mapping):
        named: dict[str, Force] = {}
        for f in forces:
            name = getattr(f, "__name__", type(f).__name__)
            if name in named:
                raise InputError(f"two forces are called {name}: give their names, forces={{\"name\": force, ...}}")
            named[name] = f
        forces = named
    for name, f in forces.items():
        if not name or set(name) & set("/,"):  # columns of a budget have this name
            raise InputError(f"a force cannot be called {name!r}: a name has no slash and no comma")
        if not callable(f):
            raise TypeError(f"the force {name} must be a function of the jet, not a {type(f).__name__}")
    return list(forces), list(forces.values())


def timed_observers(observers: Iterable[Observer]) -> tuple[list[float | None], list[Callable[[Jet], Any]]]:
    intervals: list[float | None] = []
    functions = []
    for entry in observers:
        interval, function = entry if isinstance(entry, tuple) else (None, entry)
        if not callable(function):
            raise TypeError(f"an observer must be a function of the jet, not a {type(function).__name__}")
        if interval is not None and not 0 < interval < np.inf:
            raise InputError(f"the interval of an observer is {interval} s: must be above 0 and finite")
        intervals.append(interval)
        functions.append(function)
    return intervals, functions


@contextmanager
def shown(progress: Progress) -> Iterator[Callable[[Advance], Any] | None]:
    """The function that shows progress, or None, for the duration of a run."""
    if progress is not True:
        yield progress or None
        return
    line = ProgressLine()
    try:
        yield line
    finally:
        line.clear()


class ProgressLine:
    """One line on standard error, which is written again and again."""

    def __init__(self) -> None:
        self._first: tuple[float, float] | None = None
        self._shown = 0.0

    def __call__(self, advance: Advance) -> None:
        now = time.monotonic()
        if self._first is None:
            self._first = now, advance.time
        if now - self._shown < 0.2:
            return
        self._shown = now
        start, began = self._first
        done, left = advance.time - began, advance.end_time - advance.time
        wait = f", {(now - start) * left / done:.0f} s left" if done > 0 and now - start > 1 else ""
        sys.stderr.write(f"\r{advance.time:.6g} of {advance.end_time:.6g} s, {advance.links} links{wait}\x1b[K")
        sys.stderr.flush()

    def clear(self) -> None:
        if self._shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()
