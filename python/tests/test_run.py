"""Runs into files."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import ehdjet


def data(path):
    """All that a run computes, as bytes; not how long it took, or who made the file."""
    h5py = pytest.importorskip("h5py")
    found = {}

    def add(name, item):
        if isinstance(item, h5py.Dataset) and name.split("/")[0] not in ("scene", "checkpoint"):
            found[name] = item[()].tobytes()

    with h5py.File(path) as file:
        file.visititems(add)
    return found


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("solver", ["direct", "auto"])
def test_bits_are_those_of_the_command(scene, tmp_path, command, threads, solver):
    scene["coulomb.solver"] = solver
    file = tmp_path / "scene.toml"
    file.write_text(scene.resolved)
    subprocess.run([command, "run", file, "-o", tmp_path / "command.h5", "--threads", str(threads), "--quiet"],
                   check=True)
    ehdjet.run(ehdjet.Scene(file), tmp_path / "python.h5", threads=threads)
    expected, found = data(tmp_path / "command.h5"), data(tmp_path / "python.h5")
    assert {"beads/x", "observables/tip_x", "deposit/x", "frames/time"} <= expected.keys()
    assert found == expected


def test_an_array_runs(scenes, tmp_path):
    scene = ehdjet.Scene(scenes / "array_3x3.toml")
    scene["run.end_time"] = 1e-4
    run = ehdjet.run(scene, tmp_path / "array.h5")
    assert run.status == "complete"
    assert set(np.unique(run.frame().jet)) == set(range(9))
    with pytest.raises(ehdjet.InputError, match="array"):
        ehdjet.run(scene, tmp_path / "forced.h5", forces=[lambda jet: 0 * jet.position])
    with pytest.raises(ehdjet.InputError, match="array"):
        ehdjet.Simulation(scene)


def test_files_are_not_overwritten_unasked(scene, tmp_path):
    scene["run.end_time"] = 1e-5
    ehdjet.run(scene, tmp_path / "run.h5")
    with pytest.raises(ehdjet.InputError, match=r"run\.h5.*exists.*overwrite=True"):
        ehdjet.run(scene, tmp_path / "run.h5")
    ehdjet.run(scene, tmp_path / "run.h5", overwrite=True)
    with pytest.raises(ehdjet.InputError, match="nowhere"):
        ehdjet.run(scene, tmp_path / "nowhere" / "run.h5")


def test_what_is_no_scene_is_named(tmp_path):
    for use in (lambda: ehdjet.run("quickstart.toml", tmp_path / "run.h5"), lambda: ehdjet.Simulation({})):
        with pytest.raises(TypeError, match="Scene, not a (str|dict)"):
            use()


def test_a_run_goes_on_from_a_checkpoint_with_the_same_bits(scene, tmp_path):
    scene["output.checkpoints"] = 2e-4
    whole = ehdjet.run(scene, tmp_path / "whole.h5")

    class Enough(Exception):
        pass

    def stop(jet):
        if jet.time > 5e-4:
            raise Enough("half of it")

    with pytest.raises(Enough) as stopped:
        ehdjet.run(scene, tmp_path / "part.h5", observers=[stop])
    assert "part.h5" in stopped.value.__notes__[0]
    part = ehdjet.open_run(tmp_path / "part.h5")
    assert part.status == "failed" and part.message == "an observer: Enough: half of it"
    assert len(part.frame_times) == 6
    rest = ehdjet.run(scene, tmp_path / "rest.h5", continue_from=tmp_path / "part.h5")
    assert rest.frame().equals(whole.frame())


def test_a_run_that_fails_says_so_and_keeps_what_it_has(scene, tmp_path):
    scene["integrator.min_step"] = 1e-5  # the jet needs shorter ones soon after its first release
    with pytest.raises(ehdjet.RunError) as failed:
        ehdjet.run(scene, tmp_path / "run.h5")
    assert isinstance(failed.value, RuntimeError)
    assert "at t = " in str(failed.value) and "bead" in str(failed.value) and "run.h5" in str(failed.value)
    run = ehdjet.open_run(tmp_path / "run.h5")
    assert run.status == "failed" and run.message in str(failed.value)
    assert len(run.frame_times) > 0
    simulation = ehdjet.Simulation(scene)
    with pytest.raises(ehdjet.RunError, match="at t = "):
        simulation.run_until()
    assert len(simulation.jet) > 1


def test_a_force_that_is_wrong_stops_the_run(scene, tmp_path):
    def magnet(jet):
        return np.zeros((len(jet), 2))

    with pytest.raises(ValueError, match=r"magnet returned an array of shape \(2, 2\); expected is \(2, 3\)"):
        ehdjet.run(scene, tmp_path / "run.h5", forces=[magnet])
    assert ehdjet.open_run(tmp_path / "run.h5").status == "failed"
    with pytest.raises(ehdjet.RunError, match="magnet"):  # not a number
        ehdjet.run(scene, tmp_path / "run.h5", overwrite=True,
                   forces={"magnet": lambda jet: np.full((len(jet), 3), np.nan)})


def test_own_force_and_observer(scene, tmp_path):
    seen = []

    def drag(jet):
        return -1e-6 * jet.velocity

    drags = ehdjet.run(scene, tmp_path / "drag.h5", forces=[drag],
                       observers=[(1e-4, lambda jet: seen.append((jet.time, jet.position[-1, 0])))])
    free = ehdjet.run(scene, tmp_path / "free.h5")
    assert 0 < drags.frame().x[-1] < 0.99 * free.frame().x[-1]
    assert [t for t, _ in seen] == list(drags.frame_times)  # between steps, like frames
    frames = drags.frames
    assert [x for _, x in seen] == [float(frames.x[i, n - 1]) for i, n in enumerate(frames.beads.values)]


def test_progress(scene, tmp_path, capfd):
    scene["run.end_time"] = 4e-3
    told = []
    ehdjet.run(scene, tmp_path / "run.h5", progress=told.append)
    if told:  # the run may be over before
        assert told[-1].end_time == 4e-3 and 0 < told[-1].time <= 4e-3
        assert told[-1].links > 0 and told[-1].statistics["steps"] > 0
    slow = [(1e-5, lambda jet: time.sleep(5e-3))]
    scene["run.end_time"] = 1e-3
    ehdjet.run(scene, tmp_path / "slow.h5", observers=slow, progress=True)
    assert "of 0.001 s" in capfd.readouterr().err

    def refuse(advance):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough") as stopped:
        ehdjet.run(scene, tmp_path / "stopped.h5", observers=slow, progress=refuse)
    assert "stopped by RuntimeError: enough at t = " in stopped.value.__notes__[0]
    assert ehdjet.open_run(tmp_path / "stopped.h5").status == "interrupted"


def test_other_threads_run_during_a_run(scene, tmp_path):
    scene["run.end_time"] = 3e-3
    thread = threading.Thread(target=ehdjet.run, args=(scene, tmp_path / "run.h5"))
    count = 0
    thread.start()
    while thread.is_alive():
        time.sleep(1e-3)
        count += 1
    thread.join()
    assert count > 10
    assert ehdjet.open_run(tmp_path / "run.h5").status == "complete"


@pytest.mark.parametrize("own", ["", "forces=[lambda jet: 0 * jet.position]"])
def test_ctrl_c(scene, scenes, tmp_path, own):
    """The signal comes in the middle of a run that would take hours."""
    program = textwrap.dedent(f"""
        import sys
        import ehdjet
        scene = ehdjet.Scene({str(scenes / 'pvp.toml')!r})
        scene["run.end_time"] = 1000
        try:
            ehdjet.run(scene, "run.h5", {own})
        except KeyboardInterrupt as interrupt:
            print("interrupted", interrupt.__notes__)
            sys.exit(7)
    """)
    process = subprocess.Popen([sys.executable, "-c", program], cwd=tmp_path, stdout=subprocess.PIPE, text=True,
                               env=dict(os.environ))
    while not (tmp_path / "run.h5").exists():
        assert process.poll() is None
        time.sleep(0.02)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 7
    assert "stopped by KeyboardInterrupt at t = " in out and "run.h5" in out
    run = ehdjet.open_run(tmp_path / "run.h5")
    assert run.status == "interrupted" and run.message.startswith("stopped by KeyboardInterrupt")
    assert len(run.observables) > 0
