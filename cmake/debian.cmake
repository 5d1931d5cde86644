# `cpack -G DEB` in the build folder makes the packages ehdjet and libehdjet-dev: packaging/README.md.
set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_VENDOR "The ehdjet developers")
set(CPACK_PACKAGE_CONTACT "The ehdjet developers <ehdjet@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL command development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME ehdjet)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "libehdjet-dev, snakemake, parallel, python3-h5py, paraview")
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "simulates electrospinning jets
 An electrically charged viscoelastic jet is a chain of beads from the nozzle to
 the fibre on the collector (Reneker-Yarin model), with dynamic mesh refinement
 and fast solvers for the mutual Coulomb force.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libehdjet-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libeigen3-dev, libfmt-dev, libgsl-dev, libhdf5-dev, libtomlplusplus-dev, zlib1g-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "library of the simulator of electrospinning jets
 Headers and static libraries for programs that simulate jets with force terms,
 events or observers of their own: find_package(ehdjet).")
include(CPack)
