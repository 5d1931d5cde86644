# %% [markdown]
# # From a first jet to a picture
#
# Run this file as it is, or cell by cell (Jupyter, VS Code, Spyder: a cell begins with `# %%`). It takes half a
# minute and needs numpy, pandas, xarray and matplotlib. Files go to the current folder, or to the one that is named as the
# first argument.

# %%
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import ehdjet

folder = Path(sys.argv[1]) if len(sys.argv) > 1 and Path(sys.argv[1]).is_dir() else Path(".")

# %% [markdown]
# ## A scene
#
# A scene is a TOML file, or tables as here. Everything is in SI units. What a scene does not name does not exist: this
# jet has no gravity and no air. The fluid is polyvinylpyrrolidone in ethanol, of Lauricella et al. (2016).

# %%
scene = ehdjet.Scene({
    "title": "A first jet",
    "run": {"end_time": 3e-3},
    "nozzle": {"radius": 5e-5, "link_length": 2e-4, "velocity": 2.829e-3, "density": 839.25,
               "charge_density": 14.677, "amplitude": 1e-5, "angular_frequency": 1e4},
    "collector": {"distance": 0.16},
    "field": {"potential": 9000},
    "coulomb": {},
    "viscoelasticity": {"elastic_modulus": 5e3, "viscosity": 2},
    "surface_tension": {"coefficient": 0.0211},
    "integrator": {"rtol": 1e-5},
    "output": {"observables": 2e-5, "frames": 1e-4},
})
print(scene.report())

# %% [markdown]
# Keys are changed by their names, and checked at once. A wrong one is refused with all that is known about it:

# %%
scene["field.potential"] = 9500
try:
    scene["nozzle.raduis"] = 4e-5
except ValueError as error:
    print(error)

# %% [markdown]
# ## A run
#
# `run` writes a run file and opens it. Observables are a pandas table over time, frames an xarray data set.

# %%
run = ehdjet.run(scene, folder / "first.h5", overwrite=True, progress=True)
print(run)
print(run.observables[["beads", "tip_x", "tip_yz", "path_length"]].tail(3))
print(run.frames)

# %% [markdown]
# ## A force of one's own
#
# A force is a function of the jet at one stage of a step. It returns newtons for each bead, the nozzle first. Here still
# air holds the jet back in proportion to its velocity, and an observer looks at the fastest bead every 0.1 ms.


# %%
def drag(jet):
    return -2e-7 * jet.velocity


fastest = []
simulation = ehdjet.Simulation(
    scene, forces=[drag],
    observers=[(1e-4, lambda jet: fastest.append((jet.time, np.linalg.norm(jet.velocity, axis=1).max())))])
simulation.run_until(1.5e-3)
halfway = simulation.jet  # shows this moment, also when the simulation goes on
simulation.run_until()
print(f"{simulation.statistics['evaluations']} evaluations; bead {len(halfway) - 1} was at "
      f"x = {1e3 * halfway.position[-1, 0]:.2f} mm, the tip is now at {1e3 * simulation.jet.position[-1, 0]:.2f} mm")

# %% [markdown]
# ## The Coulomb force alone
#
# The same beads, but their forces with a fast solver, and what it is wrong by:

# %%
jet = simulation.jet
exact = ehdjet.forces(jet.position, jet.charge)
fast = ehdjet.forces(jet.position, jet.charge, "fmm", 1e-6)
print(f"largest force {np.abs(exact).max():.3g} N, error of the fast multipole method "
      f"{ehdjet.force_error(jet.position, jet.charge, fast):.1e}")

# %% [markdown]
# ## A picture

# %%
figure, (side, speed) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for time in (1e-3, 2e-3, 3e-3):
    frame = run.frame(time)
    side.plot(1e3 * frame.x, 1e3 * frame.y, label=f"{1e3 * float(frame.time):.1f} ms")
side.plot(*(1e3 * jet.position[:, :2]).T, "k--", label="3.0 ms, with drag")
side.set(xlabel="x [mm]", ylabel="y [mm]", title=scene["title"])
side.legend()
table = run.observables
speed.plot(1e3 * table.index, 1e3 * table["tip_x"], label="without drag")
speed.plot(1e3 * halfway.time, 1e3 * halfway.position[-1, 0], "ks", label="with drag, halfway")
speed.plot(1e3 * jet.time, 1e3 * jet.position[-1, 0], "ko", label="with drag")
speed.set(xlabel="time [ms]", ylabel="x of the tip [mm]")
speed.legend()
figure.savefig(folder / "first.png", dpi=120)
print(f"written: {folder / 'first.h5'}, {folder / 'first.png'}")
