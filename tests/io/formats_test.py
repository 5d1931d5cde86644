"""Other programs open what ehdjet writes: xarray the run file, ASE the XYZ, and XDMF points at what is there.

usage: formats_test.py EHDJET SCENE
"""
import importlib.util
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

import h5py
import numpy as np
import xarray

command, scene = sys.argv[1:]


def there_is(module):
    return importlib.util.find_spec(module) is not None


def ehdjet(*arguments):
    subprocess.run([command, *arguments], check=True, stderr=subprocess.DEVNULL)


def expect(condition, what):
    if not condition:
        sys.exit(f"wrong: {what}")


def check_xarray(run):
    engines = [engine for engine, module in (("netcdf4", "netCDF4"), ("h5netcdf", "h5netcdf"))
               if there_is(module)]
    expect(engines, "xarray has neither netCDF4 nor h5netcdf to read with")
    with h5py.File(run) as file:
        groups = {name: {column: file[name][column][:] for column in file[name]}
                  for name in ("observables", "frames", "deposit")}
        units = {name: {column: file[name][column].attrs["unit"] for column in file[name]}
                 for name in groups}
    for engine in engines:
        for name, columns in groups.items():
            with xarray.open_dataset(run, group=name, engine=engine) as data:
                expect(set(data.variables) == set(columns), f"{engine} {name}: {set(data.variables)}")
                expect("time" in data.coords, f"{engine} {name} has no coordinate time")
                for column, values in columns.items():
                    expect(np.array_equal(data[column].values, values), f"{engine} {name}/{column}")
                    expect(data[column].attrs["units"] == units[name][column], f"unit of {column}")
                    own = column if column == "offset" else "time"
                    expect(data[column].dims == (own,), f"{engine} {column}: {data[column].dims}")
    if "netcdf4" in engines:
        with xarray.open_dataset(run, group="beads", engine="netcdf4") as data:
            expect(data.x.size == groups["frames"]["offset"][-1], "rows of /beads")


def check_xdmf(run, xdmf):
    with h5py.File(run) as file:
        times, offset = file["frames/time"][:], file["frames/offset"][:]
        frames = xml.parse(xdmf).findall("./Domain/Grid/Grid")
        expect(len(frames) == len(times) > 1, f"{len(frames)} frames")
        for k, frame in enumerate(frames):
            expect(float(frame.find("Time").get("Value")) == times[k], f"time of frame {k}")
            beads = int(offset[k + 1] - offset[k])
            expect([line.get("NodesPerElement") for line in frame.iter("Topology")] == [str(beads)], f"beads of frame {k}")
            for slab in frame.iter("DataItem"):
                if slab.get("ItemType") != "HyperSlab":
                    continue
                selection, source = slab.findall("DataItem")
                start, stride, count = map(int, selection.text.split())
                expect((start, stride, count) == (offset[k], 1, beads), f"rows of frame {k}")
                name, data_set = source.text.strip().split(":")
                expect((xdmf.parent / name).samefile(run), f"{name} is not the run file")
                expect(file[data_set].shape == (int(source.get("Dimensions")),), data_set)


def check_ase(run, xyz):
    import ase.io

    with h5py.File(run) as file:
        offset = file["frames/offset"][:]
        beads = np.stack([file["beads"][axis][:] for axis in "xyz"], axis=1)
        frames = ase.io.read(xyz, index=":", format="extxyz")
        expect(len(frames) == len(offset) - 1, f"ASE reads {len(frames)} frames")
        for k, frame in enumerate(frames):
            expect(np.array_equal(frame.positions, beads[offset[k]:offset[k + 1]]), f"frame {k}")
            expect(frame.info["Time"] == file["frames/time"][k], f"time of frame {k}")


with tempfile.TemporaryDirectory() as folder:
    folder = Path(folder)
    run = folder / "run.h5"
    ehdjet("run", scene, "-o", str(run), "--set", "run.end_time=1e-3", "--set", "output.frames=2e-4",
           "--set", "output.deposit=true")
    check_xarray(run)
    ehdjet("export", str(run), "--xdmf")
    check_xdmf(run, folder / "run.xdmf")
    if there_is("ase"):
        ehdjet("export", str(run), "--xyz", "-o", str(folder / "run.xyz"))
        check_ase(run, folder / "run.xyz")
