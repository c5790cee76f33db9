# SPDX-License-Identifier: BSD-3-Clause
# Read by cpack when the packages are made. The parts of a package bear the mode that cpack's umask gave to its temporary
# files, which nobody reads; here all get the same, so that it makes no difference.
execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C sed -i -E
  [[s,((debian-binary|control\.tar\.gz|data\.tar\.xz)/? +[0-9]+ +0 +0 +)1006[0-7]{2}  ,\1100644  ,g]]
  ${CPACK_PACKAGE_FILES} COMMAND_ERROR_IS_FATAL ANY)
