"""pip installs a package that works on its own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import ehdjet


def test_pip_installs_the_package(tmp_path):
    if not os.environ.get("EHDJET_BUILD_TREE"):
        pytest.skip("EHDJET_BUILD_TREE names no build tree to be packed")
    pytest.importorskip("pip")
    source = Path(__file__).resolve().parents[1]
    subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps", "--no-index",
                    "--target", tmp_path / "site", source], check=True, cwd=tmp_path)
    program = "import ehdjet; print(ehdjet.__file__, ehdjet.__version__, ehdjet.forces([[0, 0, 0]], [1.0]).sum())"
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, check=True, capture_output=True, text=True,
                          env=dict(os.environ, PYTHONPATH=str(tmp_path / "site")))
    assert done.stdout.split() == [str(tmp_path / "site" / "ehdjet" / "__init__.py"), ehdjet.__version__, "0.0"]
    assert (tmp_path / "site" / "ehdjet" / "py.typed").exists()
    metadata = next((tmp_path / "site").glob("ehdjet-*.dist-info")) / "METADATA"
    assert f"Version: {ehdjet.__version__}" in metadata.read_text() and "GPL" in metadata.read_text()
