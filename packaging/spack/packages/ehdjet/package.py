# Spack recipe. In a clone: spack repo add packaging/spack && spack dev-build ehdjet@0.1.0
from spack.package import *


class Ehdjet(CMakePackage):
    """Electrospinning jets as charged viscoelastic bead chains."""

    license("MIT")
    version("0.1.0")

    variant("plot", default=True, description="gnuplot, for `ehdjet plot`")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("cli11@2.1:", type="build")
    depends_on("eigen@3.4:")
    depends_on("fmt@9:")
    depends_on("gsl@2.7:")
    depends_on("hdf5@1.10:")
    depends_on("tomlplusplus@3.3:")
    depends_on("zlib-api")
    depends_on("gnuplot", type="run", when="+plot")
    depends_on("googletest +gmock", type="test")
    depends_on("py-h5py", type="test")

    conflicts("%gcc@:11", msg="needs C++20")
    generator("ninja")

    def cmake_args(self):
        return [self.define("EHDJET_BUILD_TESTS", self.run_tests)]
