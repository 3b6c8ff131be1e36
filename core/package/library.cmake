# SPDX-License-Identifier: BSD-3-Clause
# unfurl::core and unfurl::render as libraries for others: installed, found by find_package(unfurl) or pkg-config,
# or as a subproject.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# A library that can be linked into programs, shared libraries and Python modules. Its warnings are its own.
function(unfurl_library target)
  string(REPLACE unfurl_ "" name ${target})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON EXPORT_NAME ${name}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:unfurl_flags>)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>)
  target_include_directories(${target} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  if(UNFURL_INSTALL)
    install(TARGETS ${target} EXPORT unfurl-${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
      LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(EXPORT unfurl-${name} NAMESPACE unfurl:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/unfurl)
    install(DIRECTORY ${PROJECT_BINARY_DIR}/include/unfurl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  endif()
endfunction()

# Adds to `list` the headers of ours that the header (from the root) includes, and theirs.
function(unfurl_headers_of header list)
  set(found ${${list}})
  if(NOT header IN_LIST found)
    list(APPEND found ${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include \"")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"(.*)\"$" "\\1" included "${line}")
      unfurl_headers_of(${included} found)
    endforeach()
  endif()
  set(${list} ${found} PARENT_SCOPE)
endfunction()

# core/A/B.hpp is <unfurl/A/B.hpp> to others, render/A/B.hpp is <unfurl/render/A/B.hpp>: neither core/ nor render/ is a
# name to put into everybody's include path. Those named and what they include stand in the build's include folder.
function(unfurl_public_headers room)
  foreach(header IN LISTS ARGN)
    unfurl_headers_of(${room}/${header}.hpp headers)
  endforeach()
  foreach(header IN LISTS headers)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
    file(READ ${PROJECT_SOURCE_DIR}/${header} text)
    string(REGEX REPLACE "#include \"core/" "#include \"unfurl/" text "${text}")
    string(REGEX REPLACE "#include \"render/" "#include \"unfurl/render/" text "${text}")
    string(REGEX REPLACE "^core/" "" target ${header})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/include/unfurl/${target} CONTENT "${text}" @ONLY)
  endforeach()
endfunction()

function(unfurl_package)
  set(package ${CMAKE_INSTALL_LIBDIR}/cmake/unfurl)
  configure_package_config_file(${PROJECT_SOURCE_DIR}/core/package/unfurl-config.cmake.in
    ${PROJECT_BINARY_DIR}/unfurl-config.cmake INSTALL_DESTINATION ${package})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/unfurl-config-version.cmake COMPATIBILITY SameMinorVersion)
  # Relative to where the file lies, so that a prefix can be moved.
  file(RELATIVE_PATH pc_to_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  configure_file(${PROJECT_SOURCE_DIR}/core/package/unfurl.pc.in ${PROJECT_BINARY_DIR}/unfurl.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/unfurl-config.cmake ${PROJECT_BINARY_DIR}/unfurl-config-version.cmake DESTINATION ${package})
  install(FILES ${PROJECT_BINARY_DIR}/unfurl.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/assets/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/unfurl)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/assets/examples DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/README.md
    DESTINATION ${CMAKE_INSTALL_DOCDIR})
endfunction()
