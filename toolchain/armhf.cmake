# SPDX-License-Identifier: BSD-3-Clause
# Cross-compiles for 32-bit ARM boards with NEON, with Debian's g++-arm-linux-gnueabihf; programs run under qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_CXX_COMPILER arm-linux-gnueabihf-g++)
set(CMAKE_LIBRARY_ARCHITECTURE arm-linux-gnueabihf)
set(STEREOD_DEBIAN_ARCHITECTURE armhf)
set(STEREOD_EXPECTED_ISA neon)  # the matcher's kernel that the emulated CPU must get
include(${CMAKE_CURRENT_LIST_DIR}/sysroot.cmake)
# Debian's armhf does without NEON; without this the NEON kernel is not built. -Wno-psabi: g++ tells at length that it
# passed some arguments differently before version 7.1.
set(CMAKE_CXX_FLAGS_INIT "-mfpu=neon-vfpv4 -Wno-psabi")
if(CMAKE_SYSROOT)
  set(CMAKE_CROSSCOMPILING_EMULATOR qemu-arm -L ${CMAKE_SYSROOT})
else()
  set(CMAKE_CROSSCOMPILING_EMULATOR qemu-arm -L /usr/arm-linux-gnueabihf)
endif()
