# Cross-compiles for 32-bit x86 with Debian's g++-i686-linux-gnu; programs run under qemu-user as on an Atom N270, the
# first generation, which has SSSE3 and nothing newer.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR i686)
set(CMAKE_CXX_COMPILER i686-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-i386 -cpu n270 -L /usr/i686-linux-gnu)
# The median's vectors stay inside one file, so how they would be passed without SSE does not matter.
set(CMAKE_CXX_FLAGS_INIT "-Wno-psabi")
