# SPDX-License-Identifier: BSD-3-Clause
# Cross-compiles for 32-bit x86 with Debian's g++-i686-linux-gnu; programs run under qemu-user as on an Atom N270, the
# first generation, which has SSSE3 and nothing newer.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR i686)
set(CMAKE_CXX_COMPILER i686-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE i386-linux-gnu)
set(STEREOD_DEBIAN_ARCHITECTURE i386)
set(STEREOD_EXPECTED_ISA ssse3)  # the matcher's kernel that the emulated CPU must get
include(${CMAKE_CURRENT_LIST_DIR}/sysroot.cmake)
# Debian's i386 does without SSE; with it the code is smaller, and the median's vectors are the CPU's.
set(CMAKE_CXX_FLAGS_INIT "-msse2 -mfpmath=sse")
if(CMAKE_SYSROOT)
  set(CMAKE_CROSSCOMPILING_EMULATOR
    qemu-i386 -cpu n270 -L ${CMAKE_SYSROOT} -E LD_LIBRARY_PATH=${CMAKE_SYSROOT}/lib/i386-linux-gnu:${CMAKE_SYSROOT}/usr/lib/i386-linux-gnu)
else()
  # The search path keeps out /lib32, where another glibc may lie; with a wrong one the first thread hangs.
  set(CMAKE_CROSSCOMPILING_EMULATOR
    qemu-i386 -cpu n270 -L /usr/i686-linux-gnu -E LD_LIBRARY_PATH=/usr/i686-linux-gnu/lib)
endif()
