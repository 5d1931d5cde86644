# Target ehdjet::version: `#include "ehdjet/core/version.hpp"`.
# Included by the project, this file defines the target; as a script, at each build, it writes
# the header if it has changed: the commit of the last configuration may be an old one.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(header ${PROJECT_BINARY_DIR}/generated/ehdjet/core/version.hpp)
  add_custom_target(ehdjet_version_header
    COMMAND ${CMAKE_COMMAND}
      -D version=${PROJECT_VERSION}
      -D compiler=${CMAKE_CXX_COMPILER_ID}\ ${CMAKE_CXX_COMPILER_VERSION}
      -D build_type=$<CONFIG>
      -D source=${PROJECT_SOURCE_DIR}
      -D header=${header}
      -P ${CMAKE_CURRENT_LIST_FILE}
    BYPRODUCTS ${header}
    COMMENT "Looking up the commit"
    VERBATIM)

  add_library(ehdjet_version INTERFACE)
  add_library(ehdjet::version ALIAS ehdjet_version)
  add_dependencies(ehdjet_version ehdjet_version_header)
  set_target_properties(ehdjet_version PROPERTIES EXPORT_NAME version)
  target_include_directories(ehdjet_version INTERFACE
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated> $<INSTALL_INTERFACE:include>)
  return()
endif()

function(git result output) # <argument>...
  execute_process(COMMAND ${CMAKE_COMMAND} -E env GIT_OPTIONAL_LOCKS=0 git ${ARGN}
    WORKING_DIRECTORY ${source} RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_QUIET
    OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(${result} ${code} PARENT_SCOPE)
  set(${output} "${text}" PARENT_SCOPE)
endfunction()

set(commit unknown)
git(failed below_top rev-parse --show-prefix)
if(failed EQUAL 0 AND below_top STREQUAL "") # a clone of this project, not a copy inside another's
  git(failed head rev-parse --short HEAD)
  git(status_failed changes status --porcelain --untracked-files=no)
  if(failed EQUAL 0 AND status_failed EQUAL 0)
    set(commit ${head})
    if(NOT changes STREQUAL "")
      string(APPEND commit -dirty)
    endif()
  endif()
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/version.hpp.in ${header} @ONLY)
