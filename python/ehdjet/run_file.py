"""Run files."""

from __future__ import annotations

import os
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from .scene import Scene

if TYPE_CHECKING:
    import pandas
    import xarray


def open_run(path: str | os.PathLike[str]) -> Run:
    """Opens a run file. The run may still be going on, or may have been killed: what is there is read.

    Raises:
        InputError: with the path, if the file does not exist, is damaged, or is no run file
    """
    return Run(path)


class Run:
    """A run file, opened. Parts are read when they are first asked for; `refresh` reads a growing file again.

    A part that the scene did not ask for ([output]) raises InputError. `observables`, `budget` and `refinements` need
    pandas; `frames`, `frame`, `deposit` and `resolving_power` need xarray. Units are in `attrs`.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self._reader = _core.RunReader(self.path)

    def refresh(self) -> Run:
        """The file as it is now."""
        return Run(self.path)

    def __repr__(self) -> str:
        return f"<ehdjet.Run {self.path}: {self.status}>"

    @property
    def status(self) -> str:
        """"complete", "interrupted", "failed", or "running": which is also that of a run that was killed."""
        return self._reader.attribute("status")

    @property
    def message(self) -> str:
        """Why the run was interrupted or failed; otherwise empty."""
        return self._reader.attribute("message")

    @property
    def scene_text(self) -> str:
        """The scene with every default filled in (TOML)."""
        return self._reader.scene("resolved")

    @property
    def scene_given(self) -> str:
        """The text of the scene as it was read, without overrides."""
        return self._reader.scene("given")

    @cached_property
    def scene(self) -> Scene:
        """The scene, to be looked at or run again. Files that it names are looked for from the folder of the scene file.

        Raises:
            InputError: if such a file is not there any more
        """
        file = self.attribute("scene_file")
        return Scene.from_text(self.scene_text, name=f"{self.path}:/scene/resolved", folder=Path(file).parent)

    def attribute(self, name: str) -> str:
        """A text attribute of the file: "version", "commit", "threads", ..."""
        return self._reader.attribute(name)

    def has(self, part: str) -> bool:
        """Whether the file has "observables", "frames", "deposit", "refinements", "budget" or "resolving_power"."""
        return self._reader.has(part)

    @cached_property
    def observables(self) -> pandas.DataFrame:
        """Quantities of the whole jet over time [s], which is the index. ``attrs["units"]``: name -> unit."""
        return self._frame_of("observables")

    @cached_property
    def budget(self) -> pandas.DataFrame:
        """Energies [J] and momenta [kg m/s] over time [s], with what changes them, and the residual."""
        return self._frame_of("budget")

    @cached_property
    def refinements(self) -> pandas.DataFrame:
        """What each refinement changed, over time [s]."""
        return self._frame_of("refinements")

    def _frame_of(self, part: str) -> pandas.DataFrame:
        pandas = needed("pandas", part)
        columns = self._reader.table(part)
        frame = pandas.DataFrame({name: values for name, (values, _) in columns.items()}).set_index("time")
        frame.attrs["units"] = {name: unit for name, (_, unit) in columns.items()}
        return frame

    @cached_property
    def frame_times(self) -> NDArray[np.float64]:
        """Times (F,) of the frames [s]."""
        return self._reader.frame_times()

    def frame(self, time: float | None = None) -> xarray.Dataset:
        """All beads of the frame nearest to a time [s], by default of the last one: variables over the dimension "bead", 0
        the nozzle.

        Raises:
            InputError: if the run has no frame yet
        """
        xarray = needed("xarray", "frame")
        at, columns = self._reader.frame(self._reader.nearest_frame(time))
        variables = {name: variable(("bead",), values, unit) for name, (values, unit) in columns.items()}
        return xarray.Dataset(variables, coords={"bead": np.arange(beads_of(columns)),
                                                 "time": ((), at, {"units": "s"})})

    @cached_property
    def frames(self) -> xarray.Dataset:
        """All frames: variables over the dimensions "time" [s] and "bead", 0 the nozzle. `beads` (time) is the number of
        rows of each frame; behind them stands NaN, as frames differ in their number of beads.

            run.frames.x.sel(time=5e-3, method="nearest").dropna("bead")

        Takes 8 bytes per frame, variable and bead of the longest frame. Of long runs of many beads read one at a
        time (`frame`).
        """
        xarray = needed("xarray", "frames")
        times = self.frame_times
        variables: dict[str, Any] = {}
        beads = np.zeros(len(times), dtype=int)
        longest = 0
        for i in range(len(times)):
            _, columns = self._reader.frame(i)
            beads[i] = beads_of(columns)
            for name, (values, unit) in columns.items():
                if beads[i] > longest or name not in variables:
                    variables[name] = widened(variables.get(name), len(times), max(longest, beads[i]), unit)
                variables[name][1][i, :beads[i]] = values
            longest = max(longest, beads[i])
        data = {name: variable(("time", "bead"), values[:, :longest], unit)
                for name, (unit, values) in variables.items()}
        data["beads"] = (("time",), beads, {"units": "1"})
        return xarray.Dataset(data, coords={"time": (("time",), times, {"units": "s"}), "bead": np.arange(longest)})

    @cached_property
    def deposit(self) -> xarray.Dataset:
        """The fibre on the collector: variables over the dimension "landed", one entry per bead that has left the jet, in
        that order."""
        xarray = needed("xarray", "deposit")
        columns = self._reader.table("deposit")
        return xarray.Dataset({name: variable(("landed",), values, unit) for name, (values, unit) in columns.items()})

    @cached_property
    def resolving_power(self) -> xarray.DataArray:
        """R = l_step/l along the jet (time, lambda); lambda runs from 0, the nozzle, to 1, the leading bead."""
        xarray = needed("xarray", "resolving_power")
        times, places, values = self._reader.resolving_power()
        return xarray.DataArray(values.reshape(len(times), len(places)), dims=("time", "lambda"), name="R",
                                coords={"time": (("time",), times, {"units": "s"}),
                                        "lambda": (("lambda",), places, {"units": "1"})},
                                attrs={"units": "1"})


def needed(module: str, what: str) -> Any:
    """An optional module. errors: ImportError that says what needs it"""
    import importlib

    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"Run.{what} needs {module}, which is not installed (Debian: python3-{module})",
                          name=module) from error


def beads_of(columns: dict[str, tuple[NDArray[np.float64], str]]) -> int:
    return len(columns["x"][0])


def variable(dimensions: tuple[str, ...], values: NDArray[np.float64], unit: str) -> tuple[Any, ...]:
    return dimensions, values, {"units": unit}


def widened(old: Any, rows: int, width: int, unit: str) -> tuple[str, NDArray[np.float64]]:
    new = np.full((rows, width), np.nan)
    if old is not None:
        new[:, :old[1].shape[1]] = old[1]
    return unit, new
