"""Builds ehdjet._core with CMake, from the source around this folder.

Environment: CMAKE_GENERATOR and CMAKE_BUILD_PARALLEL_LEVEL as for CMake, CMAKE_ARGS for further arguments of the
configuration. EHDJET_BUILD_TREE names a build tree that has been built with EHDJET_BUILD_PYTHON=ON, to be packed as it is.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path(__file__).resolve().parent.parent


class CMakeBuild(build_ext):
    def build_extension(self, extension: Extension) -> None:
        package = Path(self.get_ext_fullpath(extension.name)).resolve().parent
        given = os.environ.get("EHDJET_BUILD_TREE")
        tree = Path(given or self.build_temp).resolve()
        if not given:
            if "CMAKE_GENERATOR" not in os.environ and shutil.which("ninja"):
                os.environ["CMAKE_GENERATOR"] = "Ninja"
            run("cmake", "-S", SOURCE, "-B", tree, "-DCMAKE_BUILD_TYPE=Release", "-DEHDJET_BUILD_PYTHON=ON",
                "-DEHDJET_BUILD_TESTS=OFF", f"-DPython_EXECUTABLE={sys.executable}",
                *os.environ.get("CMAKE_ARGS", "").split())
            run("cmake", "--build", tree, "--target", "ehdjet_python", "--parallel", str(os.cpu_count() or 1))
        # The component puts ehdjet/_core below the prefix.
        run("cmake", "--install", tree, "--component", "python", "--prefix", package.parent)


def run(*command: object) -> None:
    subprocess.run([str(word) for word in command], check=True)


version = re.search(r"project\(ehdjet VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())
assert version, "CMakeLists.txt has no version"
setup(version=version[1], ext_modules=[Extension("ehdjet._core", [])], cmdclass={"build_ext": CMakeBuild})
