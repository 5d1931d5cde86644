"""The Coulomb force on any charges."""

import threading
import time

import numpy as np
import pytest

import ehdjet

K = 8.9875517923e9  # 1/(4 pi epsilon_0) [N m^2/C^2]


@pytest.fixture
def charges():
    random = np.random.default_rng(1)
    s = np.linspace(0, 20, 3000)
    x = 1e-2 * np.stack([s, np.cos(s), np.sin(s)], axis=1)
    return x, 1e-12 * random.uniform(0.5, 1, len(x))


def test_two_charges():
    f = ehdjet.forces([[0, 0, 0], [2, 0, 0]], [1e-6, 3e-6])
    assert f.shape == (2, 3)
    np.testing.assert_allclose(f, [[-K * 3e-12 / 4, 0, 0], [K * 3e-12 / 4, 0, 0]], rtol=1e-9)


def test_direct_sum_against_numpy(charges):
    x, q = (a[:300] for a in charges)
    d = x[:, None] - x[None]
    r = np.linalg.norm(d, axis=2)
    np.fill_diagonal(r, np.inf)
    expected = K * q[:, None] * (q[None, :, None] * d / r[..., None] ** 3).sum(axis=1)
    np.testing.assert_allclose(ehdjet.forces(x, q), expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("solver", ["treecode", "fmm", "auto"])
@pytest.mark.parametrize("norm", ["global", "per-bead", "moving"])
def test_tolerances_are_kept(charges, solver, norm):
    x, q = charges
    f = ehdjet.forces(x, q, solver, 1e-5, norm=norm)
    error = ehdjet.force_error(x, q, f, norm=norm)
    assert error < 1.1e-5
    if solver != "auto":
        assert error > 1e-12  # it is no direct sum


def test_any_memory_layout_gives_the_same_bits(charges):
    x, q = charges
    f = ehdjet.forces(x, q)
    assert np.array_equal(ehdjet.forces(np.asfortranarray(x), q), f)
    wide = np.zeros((len(x), 6))
    wide[:, ::2] = x
    assert np.array_equal(ehdjet.forces(wide[:, ::2], np.repeat(q, 2)[::2]), f)
    assert np.array_equal(ehdjet.forces(x.tolist(), list(q)), f)


def test_no_charges():
    assert ehdjet.forces(np.zeros((0, 3)), []).shape == (0, 3)


@pytest.mark.parametrize(("arguments", "text"), [
    (([[0, 0]], [1]), r"x has the shape \(1, 2\); expected is \(N, 3\)"),
    (([0, 0, 0], [1]), r"x has the shape \(3\)"),
    (([[0, 0, 0]], [1, 2]), r"q has the shape \(2\); expected is \(1,\)"),
    (([[0, 0, np.nan]], [1]), r"x\[0, 2\] = nan: must be finite"),
    (([[0, 0, 0], [1, 1, 1]], [1, np.inf]), r"q\[1\] = inf: must be finite"),
    (([[0, 0, 0]], [1], "fast"), "fast.*fmm"),
    (([[0, 0, 0]], [1], "fmm", 1e-30), "tolerance"),
])
def test_wrong_arguments_are_named(arguments, text):
    with pytest.raises(ehdjet.InputError, match=text):
        ehdjet.forces(*arguments)


def test_wrong_options_are_named():
    with pytest.raises(ehdjet.InputError, match='norm = "L2": must be'):
        ehdjet.forces([[0, 0, 0]], [1], norm="L2")
    with pytest.raises(ehdjet.InputError, match="threads = 0: must be from 1 to 4096"):
        ehdjet.forces([[0, 0, 0]], [1], threads=0)
    with pytest.raises(ehdjet.InputError, match="moves has 1 entries; expected are 2"):
        ehdjet.forces([[0, 0, 0], [1, 0, 0]], [1, 1], norm="moving", moves=[True])


def test_other_threads_run_during_a_sum():
    x = np.random.default_rng(2).uniform(size=(20000, 3))
    count, done = 0, threading.Event()

    def sum_up():
        ehdjet.forces(x, np.ones(len(x)), threads=1)
        done.set()

    thread = threading.Thread(target=sum_up)
    thread.start()
    while not done.is_set():
        time.sleep(1e-3)
        count += 1
    thread.join()
    assert count > 10  # with a lock that is held it would be one or two
