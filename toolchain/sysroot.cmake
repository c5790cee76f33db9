# SPDX-License-Identifier: BSD-3-Clause
# Included by the toolchain files of foreign architectures: builds against the sysroot that make-sysroot.sh makes, if
# STEREOD_SYSROOT names one; without it only core/ can be built, with what the cross compiler brings along.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES STEREOD_SYSROOT)
if(STEREOD_SYSROOT)
  if(NOT EXISTS ${STEREOD_SYSROOT}/.complete)
    message(FATAL_ERROR
      "There is no sysroot in ${STEREOD_SYSROOT}: run toolchain/make-sysroot.sh ${STEREOD_DEBIAN_ARCHITECTURE}.")
  endif()
  set(CMAKE_SYSROOT ${STEREOD_SYSROOT})
  set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)  # lcm-gen runs here
  set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
  set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
  set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
  set(ENV{PKG_CONFIG_SYSROOT_DIR} ${STEREOD_SYSROOT})
  set(ENV{PKG_CONFIG_LIBDIR}
    ${STEREOD_SYSROOT}/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/pkgconfig:${STEREOD_SYSROOT}/usr/share/pkgconfig)
  set(ENV{PKG_CONFIG_PATH} "")
endif()
