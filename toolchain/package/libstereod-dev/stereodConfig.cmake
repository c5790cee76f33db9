# find_package(stereod): the target stereod::lcmtypes has the C++ classes of stereod's messages
# (#include <stereod/frame_t.hpp>) and LCM, which has no CMake files of its own in Debian.
if(NOT TARGET stereod::lcmtypes)
  find_path(stereod_LCM_INCLUDE_DIR lcm/lcm-cpp.hpp)
  find_library(stereod_LCM_LIBRARY lcm)
  if(NOT stereod_LCM_INCLUDE_DIR OR NOT stereod_LCM_LIBRARY)
    set(stereod_FOUND FALSE)
    set(stereod_NOT_FOUND_MESSAGE "LCM is missing: install the Debian package liblcm-dev.")
    return()
  endif()
  get_filename_component(stereod_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
  add_library(stereod::lcmtypes INTERFACE IMPORTED)
  set_target_properties(stereod::lcmtypes PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${stereod_prefix}/include;${stereod_LCM_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${stereod_LCM_LIBRARY}")
endif()
