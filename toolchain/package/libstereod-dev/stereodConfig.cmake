# SPDX-License-Identifier: BSD-3-Clause
# find_package(stereod): the target stereod::lcmtypes has the C++ classes of stereod's messages
# (#include <stereod/frame_t.hpp>) and LCM, which has no CMake files of its own in Debian; the target stereod::client has
# the client library (#include <stereod/stereod_client.h>), C++17.
if(NOT TARGET stereod::lcmtypes)
  find_path(stereod_LCM_INCLUDE_DIR lcm/lcm-cpp.hpp)
  find_library(stereod_LCM_LIBRARY lcm)
  if(NOT stereod_LCM_INCLUDE_DIR OR NOT stereod_LCM_LIBRARY)
    set(stereod_FOUND FALSE)
    set(stereod_NOT_FOUND_MESSAGE "LCM is missing: install the Debian package liblcm-dev.")
    return()
  endif()
  find_library(stereod_CLIENT_LIBRARY stereod-client HINTS "${CMAKE_CURRENT_LIST_DIR}/../.." REQUIRED)
  find_path(stereod_INCLUDE_DIR stereod/stereod_client.h HINTS "${CMAKE_CURRENT_LIST_DIR}/../../../../include"
    "${CMAKE_CURRENT_LIST_DIR}/../../../include" REQUIRED)
  add_library(stereod::lcmtypes INTERFACE IMPORTED)
  set_target_properties(stereod::lcmtypes PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${stereod_INCLUDE_DIR};${stereod_LCM_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${stereod_LCM_LIBRARY}")
  add_library(stereod::client STATIC IMPORTED)
  set_target_properties(stereod::client PROPERTIES
    IMPORTED_LOCATION "${stereod_CLIENT_LIBRARY}" INTERFACE_LINK_LIBRARIES stereod::lcmtypes)
endif()
