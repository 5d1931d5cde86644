"""The tutorial runs from its beginning to its picture, and says what it shows."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

TUTORIAL = Path(__file__).resolve().parents[1] / "tutorial" / "first_jet.py"


def test_the_tutorial_runs(tmp_path):
    pytest.importorskip("matplotlib")
    done = subprocess.run([sys.executable, TUTORIAL], cwd=tmp_path, capture_output=True, text=True,
                          env=dict(os.environ, MPLBACKEND="Agg", MPLCONFIGDIR=str(tmp_path)))
    assert done.returncode == 0, done.stderr
    assert "nozzle.raduis" in done.stdout  # the refused key
    assert "first.h5: complete" in done.stdout
    picture = (tmp_path / "first.png").read_bytes()
    assert picture.startswith(b"\x89PNG") and len(picture) > 10000
