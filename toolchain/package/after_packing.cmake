# SPDX-License-Identifier: BSD-3-Clause
# Read by cpack when the packages are made. The members of a package carry the mode that cpack's umask gave to its
# temporary files; all get the same mode here, so that packages are reproducible.
execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C sed -i -E
  [[s,((debian-binary|control\.tar\.gz|data\.tar\.xz)/? +[0-9]+ +0 +0 +)1006[0-7]{2}  ,\1100644  ,g]]
  ${CPACK_PACKAGE_FILES} COMMAND_ERROR_IS_FATAL ANY)
