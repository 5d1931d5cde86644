"""Run files as pandas and xarray see them."""

import shutil
import sys

import numpy as np
import pytest

import ehdjet


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    from conftest import JET

    scene = ehdjet.Scene(JET)
    scene["output.budget"] = 1e-4
    scene["output.resolving_power"] = 5e-4
    return ehdjet.run(scene, tmp_path_factory.mktemp("run") / "run.h5")


def test_tables_over_time(run):
    table = run.observables
    assert table.index.name == "time" and len(table) == 11
    np.testing.assert_allclose(table.index, np.arange(11) * 1e-4, atol=1e-12)
    assert table.attrs["units"]["tip_x"] == "m" and table.attrs["units"]["time"] == "s"
    assert table["tip_x"].iloc[-1] == float(run.frame().x[-1])
    assert abs(run.budget["energy_residual_relative"].iloc[-1]) < 1e-3
    assert run.observables is table  # read once


def test_frames(run):
    frames = run.frames
    assert frames.sizes == {"time": 11, "bead": int(frames.beads.max())}
    assert frames.x.attrs["units"] == "m" and frames.time.attrs["units"] == "s"
    for i, time in enumerate(run.frame_times):
        one, n = run.frame(time), int(frames.beads[i])
        assert one.sizes["bead"] == n and float(one.time) == time
        for name in one.data_vars:
            assert np.array_equal(frames[name][i, :n], one[name]), name
            assert np.isnan(frames[name][i, n:]).all()
    assert int(frames.beads[0]) < int(frames.beads[-1])
    nearest = frames.x.sel(time=5.2e-4, method="nearest").dropna("bead")
    assert np.array_equal(nearest, run.frame(5e-4).x)
    assert float(run.frame().time) == 1e-3


def test_frames_go_to_netcdf_and_back(run, tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    run.frames.to_netcdf(tmp_path / "frames.nc")
    with xarray.open_dataset(tmp_path / "frames.nc") as again:
        assert np.array_equal(again.x, run.frames.x, equal_nan=True)


def test_resolving_power(run):
    power = run.resolving_power
    assert power.dims == ("time", "lambda") and power.shape == (3, 101)
    assert float(power["lambda"][-1]) == 1 and (power > 0).all()


def test_what_a_run_is(run):
    assert run.status == "complete" and run.message == ""
    assert run.scene.resolved == run.scene_text
    assert run.scene["title"] == "PVP jet"
    assert run.attribute("version") == ehdjet.__version__
    assert run.has("deposit") and not run.has("refinements")
    assert run.deposit.sizes == {"landed": 0}
    assert run.deposit.mass.attrs["units"] == "kg"
    with pytest.raises(ehdjet.InputError, match=r"run\.h5.*refinements"):
        run.refinements
    assert run.refresh().status == "complete"


def test_a_deposit(tmp_path, scene):
    scene.update({"run.end_time": 4e-3, "collector.distance": 5e-3})
    run = ehdjet.run(scene, tmp_path / "run.h5")
    assert run.deposit.sizes["landed"] > 5
    np.testing.assert_allclose(run.deposit.x, 5e-3)
    assert (np.diff(run.deposit.time) >= 0).all()


def test_files_that_are_no_runs_are_refused(tmp_path):
    with pytest.raises(ehdjet.InputError, match="absent.h5"):
        ehdjet.open_run(tmp_path / "absent.h5")
    (tmp_path / "text.h5").write_text("no HDF5")
    with pytest.raises(ehdjet.InputError, match="text.h5"):
        ehdjet.open_run(tmp_path / "text.h5")


def test_arrays_stay_when_the_file_is_gone(run, tmp_path):
    copy = tmp_path / "copy.h5"
    shutil.copy(run.path, copy)
    x = ehdjet.open_run(copy).frame().x.values
    copy.unlink()
    assert np.array_equal(x, run.frame().x)


@pytest.mark.parametrize(("module", "part"), [("pandas", "observables"), ("xarray", "frames"), ("xarray", "deposit")])
def test_a_module_that_is_missing_is_named(run, monkeypatch, module, part):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ImportError, match=f"Run.{part} needs {module}, which is not installed"):
        getattr(run.refresh(), part)
