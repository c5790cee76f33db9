# SPDX-License-Identifier: BSD-3-Clause
# For Atom-class boards of the 64-bit x86 architecture: runs on every such CPU, scheduled for a Silvermont.
set(CMAKE_CXX_FLAGS_INIT "-mtune=silvermont")
