# Toolchain of Debian's cross compiler (g++-aarch64-linux-gnu). Libraries are found as they are on this machine: their headers serve, and
# nothing is linked.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

file(GLOB libraries /usr/lib/${CMAKE_HOST_SYSTEM_PROCESSOR}-linux-gnu)
list(APPEND CMAKE_LIBRARY_PATH ${libraries})
foreach(package IN ITEMS fmt tomlplusplus CLI11)
  file(GLOB ${package}_DIR ${libraries}/cmake/${package})
endforeach()
