# SPDX-License-Identifier: BSD-3-Clause
# Read by cpack: packages carry the time of the commit, not of the build, so that two builds of a commit are equal.
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  execute_process(COMMAND git -C ${CMAKE_CURRENT_LIST_DIR} log -1 --format=%ct
    OUTPUT_VARIABLE commit_time OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE no_git ERROR_QUIET)
  if(NOT no_git AND commit_time)
    set(ENV{SOURCE_DATE_EPOCH} ${commit_time})
  endif()
endif()
# dpkg-shlibdeps looks into the sysroot a foreign package was built against.
if(CPACK_SYSROOT)
  set(ENV{DPKG_ADMINDIR} ${CPACK_SYSROOT}/var/lib/dpkg)
endif()
