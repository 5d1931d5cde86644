"""Simulations step by step, and the arrays that they show."""

import gc
import sys
import threading
import weakref

import numpy as np
import pytest

import ehdjet


def test_steps_and_runs_are_the_same(scene, tmp_path):
    by_run, by_step = ehdjet.Simulation(scene), ehdjet.Simulation(scene)
    by_run.run_until()
    while by_step.step():
        pass
    assert by_run.time == by_step.time == 1e-3
    assert np.array_equal(by_run.jet.position, by_step.jet.position)
    assert by_run.statistics["steps"] == by_step.statistics["steps"] > 10
    by_run.run_until(5e-4)  # is behind it
    assert by_run.time == 1e-3

    frame = ehdjet.run(scene, tmp_path / "run.h5").frame()
    jet = by_run.jet
    assert set(jet.units) == set(frame.data_vars)
    for name, unit in jet.units.items():
        assert np.array_equal(jet[name], frame[name]), name
        assert frame[name].attrs["units"] == unit


def test_fields_have_their_shapes(scene):
    simulation = ehdjet.Simulation(scene)
    simulation.run_until(5e-4)
    jet = simulation.jet
    n = len(jet)
    assert n > 5 and jet.time == 5e-4
    assert jet.position.shape == jet.velocity.shape == (n, 3)
    for name in ("mass", "charge", "volume", "radius", "landed", "embryo"):
        assert getattr(jet, name).shape == (n,)
        assert np.array_equal(getattr(jet, name), jet[name])
    assert jet["stress"].shape == (n,) and "stress" in jet and "strain" not in jet
    assert np.array_equal(jet.position[:, 1], jet["y"]) and np.array_equal(jet.velocity[:, 0], jet["vx"])
    with pytest.raises(KeyError, match="no column strain; it has x, y"):
        jet["strain"]
    ledger = simulation.ledger
    assert ledger["inserted_beads"] - ledger["removed_beads"] == n - 1
    assert ledger["inserted_mass"] == pytest.approx(jet.mass[1:].sum())


def test_radii_of_a_drying_jet_are_those_of_the_file(scenes, tmp_path):
    scene = ehdjet.Scene(scenes / "fibre.toml")
    scene.update({"run.end_time": 2e-3, "output.frames": 2e-3})
    simulation = ehdjet.Simulation(scene)
    simulation.run_until()
    frame = ehdjet.run(scene, tmp_path / "fibre.h5").frame()
    assert simulation.jet["evaporated"].max() > 1e-4
    assert np.array_equal(simulation.jet.radius, frame.radius)


def test_arrays_are_views_that_cannot_be_written(scene):
    simulation = ehdjet.Simulation(scene)
    simulation.run_until(2e-4)
    first, second = simulation.jet.position, simulation.jet.position
    assert first.ctypes.data == second.ctypes.data  # no copies
    assert simulation.jet["x"].ctypes.data == first.ctypes.data
    with pytest.raises(ValueError):
        first[0, 0] = 1
    with pytest.raises(ValueError):
        first.flags.writeable = True


def test_views_stay_when_the_simulation_goes_on(scene):
    simulation, alone = ehdjet.Simulation(scene), ehdjet.Simulation(scene)
    views, copies = [], []
    while simulation.time < 5e-4:
        for _ in range(20):
            simulation.step()
        jet = simulation.jet
        arrays = [jet.position, jet["stress"], jet.charge, jet.mass[1:]]
        views.append(arrays)
        copies.append([a.copy() for a in arrays])
        del jet, arrays
    gc.collect()
    rubbish = [np.full(len(v[0]) * 3, 7.0) for v in views for _ in range(50)]  # would be in freed memory
    for arrays, expected in zip(views, copies):
        for a, b in zip(arrays, expected):
            assert np.array_equal(a, b)
    del rubbish
    # And the simulation has not been disturbed by being looked at.
    for _ in range(simulation.statistics["steps"]):
        alone.step()
    assert np.array_equal(alone.jet.position, simulation.jet.position)


def test_views_stay_when_the_simulation_is_gone(scene):
    simulation = ehdjet.Simulation(scene)
    simulation.run_until(5e-4)
    jet = simulation.jet
    x, stress = jet.position, simulation.jet["stress"]
    expected = x.copy(), stress.copy()
    del simulation
    gc.collect()
    other = ehdjet.Simulation(scene)
    other.run_until()
    assert np.array_equal(x, expected[0]) and np.array_equal(stress, expected[1])
    assert np.array_equal(jet.position, x)  # the jet is still there, too
    assert jet.landed.sum() == 0


def test_simulations_with_functions_that_refer_to_them_are_collected(scene):
    scene["run.end_time"] = 1e-5

    class Owner:
        def __init__(self):
            self.simulation = ehdjet.Simulation(scene, forces={"own": self.force}, observers=[self.see])

        def force(self, jet):
            return 0 * jet.position

        def see(self, jet):
            self.seen = jet.position

    owner = Owner()
    owner.simulation.run_until()
    assert owner.seen.shape[1] == 3
    gone = weakref.ref(owner)
    del owner
    gc.collect()
    assert gone() is None


def test_functions_and_arrays_are_not_leaked(scene):
    scene["run.end_time"] = 1e-5

    def force(jet):
        return 0 * jet.position

    before = sys.getrefcount(force)
    for _ in range(3):
        simulation = ehdjet.Simulation(scene, forces=[force])
        simulation.run_until()
        kept = simulation.jet.position
    del simulation, kept
    gc.collect()
    assert sys.getrefcount(force) == before


def test_a_jet_ends_with_the_call_that_got_it(scene):
    kept = {}

    def force(jet):
        kept["force"] = jet, jet.position
        with pytest.raises(RuntimeError, match="simulation is running"):
            simulation.jet
        return np.zeros((len(jet), 3))

    simulation = ehdjet.Simulation(scene, forces=[force],
                                   observers=[lambda jet: kept.update(observer=(jet, jet.position))])
    for _ in range(5):
        simulation.step()
    last = simulation.jet.position.copy()
    simulation.run_until(5e-5)
    for jet, position in kept.values():
        assert position.flags.owndata  # a copy
        with pytest.raises(RuntimeError, match="only during the call"):
            jet.position
    assert not np.array_equal(kept["observer"][1], last)


def test_own_force_is_a_term_like_others(scene):
    """Gravity, once of the scene and once of one's own."""
    g = 100.0
    theirs = scene.copy()
    theirs["gravity"] = {"acceleration": g}
    for each in (scene, theirs):  # an own force switches two rates off
        each["integrator.method"] = "dormand-prince"
    mine = ehdjet.Simulation(scene, forces={"weight": lambda jet: g * jet.mass[:, None] * [1.0, 0.0, 0.0]})
    library = ehdjet.Simulation(theirs)
    mine.run_until()
    library.run_until()
    plain = ehdjet.Simulation(scene)
    plain.run_until()
    np.testing.assert_allclose(mine.jet.position, library.jet.position, rtol=1e-9)
    assert abs(mine.jet.position[-1, 0] / plain.jet.position[-1, 0] - 1) > 1e-3


def test_names_of_forces(scene):
    force = lambda jet: 0 * jet.position  # noqa: E731
    with pytest.raises(ehdjet.InputError, match="two forces are called <lambda>"):
        ehdjet.Simulation(scene, forces=[force, force])
    ehdjet.Simulation(scene, forces={"a": force, "b": force}).step()
    with pytest.raises(TypeError, match="force a must be a function"):
        ehdjet.Simulation(scene, forces={"a": 1})
    with pytest.raises(ehdjet.InputError, match="cannot be called 'a/b'"):
        ehdjet.Simulation(scene, forces={"a/b": force})
    with pytest.raises(ehdjet.InputError, match="interval of an observer is -1"):
        ehdjet.Simulation(scene, observers=[(-1, force)])


def test_what_a_force_raises_comes_out(scene):
    class Broken(Exception):
        pass

    def force(jet):
        if jet.time > 1e-5:
            raise Broken("no magnet there")
        return 0 * jet.position

    simulation = ehdjet.Simulation(scene, forces=[force])
    with pytest.raises(Broken, match="no magnet there") as broken:
        simulation.run_until()
    assert any(entry.name == "force" for entry in broken.traceback)
    before = simulation.time
    assert 0 < before <= 1.1e-5
    with pytest.raises(RuntimeError, match="has failed"):
        simulation.step()
    assert len(simulation.jet) > 1 and simulation.time == before


def test_ctrl_c_in_a_force_ends_with_the_step(scene):
    calls = []

    def force(jet):
        calls.append(jet.time)
        if len(calls) == 100:
            raise KeyboardInterrupt
        return 0 * jet.position

    plain, stopped = ehdjet.Simulation(scene, forces={"f": lambda jet: 0 * jet.position}), \
        ehdjet.Simulation(scene, forces={"f": force})
    with pytest.raises(KeyboardInterrupt) as interrupt:
        stopped.run_until()
    assert "can go on" in interrupt.value.__notes__[0]
    assert calls[99] == calls[100] and 0 < stopped.time < 1e-3
    stopped.run_until()
    plain.run_until()
    assert np.array_equal(stopped.jet.position, plain.jet.position)


def test_nobody_looks_at_a_simulation_that_runs(scene):
    scene["run.end_time"] = 5e-3
    inside, go_on = threading.Event(), threading.Event()

    def wait(jet):
        inside.set()
        go_on.wait(60)

    simulation = ehdjet.Simulation(scene, observers=[(1e-3, wait)])
    thread = threading.Thread(target=simulation.run_until, args=(2e-3,))
    thread.start()
    assert inside.wait(60)
    for look in (lambda: simulation.jet, lambda: simulation.time, lambda: simulation.step(),
                 lambda: simulation.statistics):
        with pytest.raises(RuntimeError, match="is running"):
            look()
    go_on.set()
    thread.join()
    assert simulation.time == 2e-3


def test_wrong_times(scene):
    simulation = ehdjet.Simulation(scene)
    with pytest.raises(ehdjet.InputError, match="end_time = nan"):
        simulation.run_until(float("nan"))
    with pytest.raises(ehdjet.InputError, match="end_time = inf"):
        simulation.step(float("inf"))
