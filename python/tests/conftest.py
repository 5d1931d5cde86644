import os
from pathlib import Path

import pytest

import ehdjet

# The PVP jet of scenes/pvp.toml: inserts a bead every few microseconds.
JET = {
    "title": "PVP jet",
    "run": {"end_time": 1e-3},
    "nozzle": {"radius": 5e-5, "link_length": 2e-4, "velocity": 2.82942121e-3, "density": 839.253525,
               "charge_density": 14.67682018871869, "amplitude": 1e-5, "angular_frequency": 1e4},
    "collector": {"distance": 0.16, "charge": "kept"},
    "field": {"potential": 9000},
    "coulomb": {},
    "viscoelasticity": {"elastic_modulus": 5e3, "viscosity": 2},
    "surface_tension": {"coefficient": 0.021133},
    "integrator": {"rtol": 1e-5},
    "output": {"observables": 1e-4, "frames": 1e-4, "deposit": True},
}


@pytest.fixture
def scene() -> ehdjet.Scene:
    return ehdjet.Scene(JET)


@pytest.fixture(scope="session")
def scenes() -> Path:
    """The folder with the scenes of ehdjet."""
    folder = os.environ.get("EHDJET_SCENES")
    return Path(folder) if folder else Path(__file__).resolve().parents[2] / "scenes"


@pytest.fixture(scope="session")
def command() -> str:
    path = os.environ.get("EHDJET_COMMAND")
    if not path:
        pytest.skip("EHDJET_COMMAND does not name the command")
    return path
