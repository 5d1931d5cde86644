# What `cmake --install` installs: libraries, headers, the command, the scenes, and the package
# that find_package(ehdjet) finds. Link one concept (ehdjet::jet) or all of them (ehdjet::ehdjet).
get_property(concepts GLOBAL PROPERTY ehdjet_concepts)
add_library(ehdjet_everything INTERFACE)
add_library(ehdjet::ehdjet ALIAS ehdjet_everything)
set_target_properties(ehdjet_everything PROPERTIES EXPORT_NAME ehdjet)
foreach(concept IN LISTS concepts)
  get_target_property(name ${concept} EXPORT_NAME)
  target_link_libraries(ehdjet_everything INTERFACE ehdjet::${name})
endforeach()

if(NOT PROJECT_IS_TOP_LEVEL)
  return() # this is a part of another project, which decides what it installs
endif()

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ehdjet)

set_target_properties(ehdjet_cli PROPERTIES EXPORT_NAME command)
install(TARGETS ${concepts} ehdjet_version ehdjet_everything ehdjet_cli EXPORT ehdjetTargets)
install(EXPORT ehdjetTargets NAMESPACE ehdjet:: DESTINATION ${package_dir})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ehdjet DESTINATION include
  FILES_MATCHING PATTERN "*.hpp")
install(FILES ${PROJECT_BINARY_DIR}/generated/ehdjet/core/version.hpp
  DESTINATION include/ehdjet/core)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/ehdjet)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/ehdjetConfig.cmake.in
  ${PROJECT_BINARY_DIR}/ehdjetConfig.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ehdjetConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ehdjetConfig.cmake
  ${PROJECT_BINARY_DIR}/ehdjetConfigVersion.cmake DESTINATION ${package_dir})
