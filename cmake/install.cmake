# What `cmake --install` installs: the command with its manual page, completion, scenes and workflows (component
# `command`); libraries, headers and the package that find_package(ehdjet) finds (component `development`). Link
# one concept (ehdjet::jet) or all of them (ehdjet::ehdjet).
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
install(TARGETS ehdjet_cli COMPONENT command)
install(TARGETS ${concepts} ehdjet_version ehdjet_everything EXPORT ehdjetTargets COMPONENT development)
install(EXPORT ehdjetTargets NAMESPACE ehdjet:: DESTINATION ${package_dir} COMPONENT development)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ehdjet DESTINATION include COMPONENT development
  FILES_MATCHING PATTERN "*.hpp")
install(FILES ${PROJECT_BINARY_DIR}/generated/ehdjet/core/version.hpp
  DESTINATION include/ehdjet/core COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/ehdjet COMPONENT command)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scripts/workflows DESTINATION ${CMAKE_INSTALL_DATADIR}/ehdjet
  USE_SOURCE_PERMISSIONS COMPONENT command)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/ehdjetConfig.cmake.in
  ${PROJECT_BINARY_DIR}/ehdjetConfig.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ehdjetConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ehdjetConfig.cmake
  ${PROJECT_BINARY_DIR}/ehdjetConfigVersion.cmake DESTINATION ${package_dir} COMPONENT development)

# The manual page and the completion are made by the command itself. Debian wants what is read with zless to be
# compressed, with the same bytes every time.
find_program(EHDJET_GZIP gzip)
mark_as_advanced(EHDJET_GZIP)
set(documents ${PROJECT_BINARY_DIR}/documents)
file(MAKE_DIRECTORY ${documents})
# ehdjet_document(<command> <file>): what `ehdjet <command>` prints
function(ehdjet_document command file)
  add_custom_command(OUTPUT ${documents}/${file} COMMAND ehdjet_cli ${command} > ${documents}/${file} VERBATIM)
  set_property(GLOBAL APPEND PROPERTY ehdjet_documents ${documents}/${file})
endfunction()
# install_compressed(<file> <folder> <name there>)
function(install_compressed file folder name)
  if(EHDJET_GZIP)
    add_custom_command(OUTPUT ${documents}/${name}.gz DEPENDS ${file}
      COMMAND ${EHDJET_GZIP} -9nc ${file} > ${documents}/${name}.gz VERBATIM)
    set_property(GLOBAL APPEND PROPERTY ehdjet_documents ${documents}/${name}.gz)
    install(FILES ${documents}/${name}.gz DESTINATION ${folder} COMPONENT command)
  else()
    install(FILES ${file} DESTINATION ${folder} RENAME ${name} COMPONENT command)
  endif()
endfunction()
if(NOT CMAKE_CROSSCOMPILING OR CMAKE_CROSSCOMPILING_EMULATOR) # else the command cannot run here
  ehdjet_document(manual ehdjet.1)
  install_compressed(${documents}/ehdjet.1 ${CMAKE_INSTALL_MANDIR}/man1 ehdjet.1)
  ehdjet_document(completion ehdjet.bash)
  install(FILES ${documents}/ehdjet.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME ehdjet COMPONENT command)
endif()
install_compressed(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${CMAKE_INSTALL_DOCDIR} changelog)
get_property(all_documents GLOBAL PROPERTY ehdjet_documents)
add_custom_target(ehdjet_documents ALL DEPENDS ${all_documents})
set(copyright ${PROJECT_SOURCE_DIR}/packaging/copyright)
install(FILES ${copyright} DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT command)
install(FILES ${copyright} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libehdjet-dev COMPONENT development)

include(${CMAKE_CURRENT_LIST_DIR}/debian.cmake)
