# SPDX-License-Identifier: BSD-3-Clause
# What is installed, and the three Debian packages made of it by cpack: stereod (the daemon and the tools beside it),
# stereo-calibrate (the only one that needs OpenCV) and libstereod-dev (for programs that receive what stereod sends).
include(GNUInstallDirs)
set(package_dir ${CMAKE_CURRENT_LIST_DIR})
set(unit_dir lib/systemd/system)  # Debian 12's, seen from the root

# --- stereod
set(programs stereod stereo-match stereo-tap)
if(TARGET stereo-view)
  list(APPEND programs stereo-view)
endif()
install(TARGETS ${programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT stereod)
install(FILES ${PROJECT_SOURCE_DIR}/etc/stereod.yaml DESTINATION /etc/stereod COMPONENT stereod)
install(FILES
  ${PROJECT_SOURCE_DIR}/systemd/stereod.service
  ${PROJECT_SOURCE_DIR}/systemd/stereod@.service
  ${PROJECT_SOURCE_DIR}/systemd/stereod-multicast.service
  DESTINATION /${unit_dir} COMPONENT stereod)
install(FILES ${PROJECT_SOURCE_DIR}/systemd/sysusers.d/stereod.conf
  DESTINATION lib/sysusers.d COMPONENT stereod)
install(FILES ${PROJECT_SOURCE_DIR}/etc/sysctl.d/00-stereod.conf DESTINATION lib/sysctl.d COMPONENT stereod)
install(FILES ${PROJECT_SOURCE_DIR}/etc/udev/60-stereod.rules DESTINATION /lib/udev/rules.d COMPONENT stereod)
install(FILES ${PROJECT_SOURCE_DIR}/etc/demo.yaml
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/stereod/examples COMPONENT stereod)
# Drop-ins to copy.
install(FILES ${PROJECT_SOURCE_DIR}/systemd/examples/realtime.conf
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/stereod/examples COMPONENT stereod)

if(TARGET stereod-spy)
  install(PROGRAMS ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/stereod-spy DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT stereod)
  install(FILES ${CMAKE_BINARY_DIR}/share/stereod/stereod-spy.jar
    DESTINATION ${CMAKE_INSTALL_DATADIR}/stereod COMPONENT stereod)
endif()

# --- stereo-calibrate
if(TARGET stereo-calibrate)
  install(TARGETS stereo-calibrate RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT stereo-calibrate)
endif()

# --- libstereod-dev
get_target_property(lcm_header_dir stereod_lcmtypes STEREOD_GENERATED_DIR)
install(TARGETS stereod_client ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libstereod-dev)
# Every header of daemon/client, but nothing of its subdirectories.
file(GLOB client_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/daemon/client/*.h)
install(FILES ${client_headers}
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stereod COMPONENT libstereod-dev)
install(DIRECTORY ${lcm_header_dir}/stereod DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT libstereod-dev
  FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/daemon/lcmtypes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/lcmtypes
  COMPONENT libstereod-dev FILES_MATCHING PATTERN "*.lcm")
include(CMakePackageConfigHelpers)
configure_file(${package_dir}/libstereod-dev/stereod.pc.in ${CMAKE_BINARY_DIR}/package/stereod.pc @ONLY)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/stereodConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/package/stereod.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT libstereod-dev)
install(FILES ${package_dir}/libstereod-dev/stereodConfig.cmake ${CMAKE_BINARY_DIR}/package/stereodConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/stereod COMPONENT libstereod-dev)

# --- what every package has: manual pages, license, changes
find_program(GZIP gzip REQUIRED)
# gzip -n keeps the time out, so that two builds give the same bytes.
function(install_compressed source name destination component)
  set(packed ${CMAKE_BINARY_DIR}/package/${component}/${name}.gz)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/package/${component})
  execute_process(COMMAND ${GZIP} -9nc ${source} OUTPUT_FILE ${packed} COMMAND_ERROR_IS_FATAL ANY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
  install(FILES ${packed} DESTINATION ${destination} COMPONENT ${component})
endfunction()
function(install_manual page component)
  string(REGEX REPLACE ".*\\." "" section ${page})
  install_compressed(${PROJECT_SOURCE_DIR}/docs/man/${page} ${page} ${CMAKE_INSTALL_MANDIR}/man${section} ${component})
endfunction()

set(components stereod libstereod-dev)
if(TARGET stereo-calibrate)
  list(APPEND components stereo-calibrate)
  install_manual(stereo-calibrate.1 stereo-calibrate)
endif()
set(pages stereod.8 stereod.yaml.5 stereo-match.1 stereo-tap.1)
if(TARGET stereo-view)
  list(APPEND pages stereo-view.1)
endif()
if(TARGET stereod-spy)
  list(APPEND pages stereod-spy.1)
endif()
foreach(page IN LISTS pages)
  install_manual(${page} stereod)
endforeach()
foreach(component IN LISTS components)
  set(doc_dir ${CMAKE_INSTALL_DATADIR}/doc/${component})
  install_compressed(${package_dir}/changelog changelog ${doc_dir} ${component})
  install(FILES ${package_dir}/copyright DESTINATION ${doc_dir} COMPONENT ${component})
endforeach()

# What the programs of a package link, by library and version: written when they are installed.
function(install_bill component headers)
  list(TRANSFORM ARGN REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE files)
  list(JOIN files "\" \"" files)
  install(CODE "execute_process(COMMAND \"${package_dir}/bill-of-materials.sh\"
    --name ${component} --version ${PROJECT_VERSION} --headers \"${headers}\"
    --sysroot \"${CMAKE_SYSROOT}\" --objdump \"${CMAKE_OBJDUMP}\"
    --output \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/doc/${component}/bill-of-materials.spdx\"
    \"${files}\" COMMAND_ERROR_IS_FATAL ANY)"
    COMPONENT ${component})
endfunction()
install_bill(stereod "libcli11-dev libspdlog-dev" ${programs})
if(TARGET stereo-calibrate)
  install_bill(stereo-calibrate "libcli11-dev" stereo-calibrate)
endif()

# What the packages hold, for a build that makes them and nothing else.
add_custom_target(packaged DEPENDS ${programs} stereod_client)
foreach(target stereo-calibrate stereod-spy stereod_python_types)
  if(TARGET ${target})
    add_dependencies(packaged ${target})
  endif()
endforeach()

# --- cpack
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME stereod)
# Equal to its default, so that it is not put before what each package says of itself.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_NAME} built using CMake")
set(CPACK_PACKAGE_CONTACT "The stereod authors <stereod@stereod.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR})
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PROJECT_CONFIG_FILE ${package_dir}/before_cpack.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${package_dir}/before_packing.cmake)
set(CPACK_POST_BUILD_SCRIPTS ${package_dir}/after_packing.cmake)
set(CPACK_SYSROOT ${CMAKE_SYSROOT})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION})
if(STEREOD_DEBIAN_ARCHITECTURE)  # a toolchain file says it
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE ${STEREOD_DEBIAN_ARCHITECTURE})
endif()
if(CMAKE_SYSROOT)
  # Dependencies are told by the sysroot's own list of packages.
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS
    ${CMAKE_SYSROOT}/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE} ${CMAKE_SYSROOT}/lib/${CMAKE_LIBRARY_ARCHITECTURE})
endif()

set(CPACK_DEBIAN_STEREOD_PACKAGE_NAME stereod)
set(CPACK_DEBIAN_STEREOD_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_STEREOD_PACKAGE_DEPENDS "systemd (>= 252) | systemd-standalone-sysusers, udev, iproute2")
set(CPACK_DEBIAN_STEREOD_PACKAGE_SUGGESTS "stereo-calibrate, v4l-utils, liblcm-bin, liblcm-java, libjchart2d-java, default-jre")
set(CPACK_COMPONENT_STEREOD_DESCRIPTION "stereo vision daemon for robot boards
Reads two webcams, rectifies their images with a lookup table, matches them
with a threaded SIMD matcher, semi-global or by blocks, and publishes rows
of disparity over LCM to the other processes of the robot. With the tools
stereo-tap (watch, save and check what is published), stereo-view (a live
page), stereod-spy (LCM's spy) and stereo-match (the same matcher on two
files).")
set(CPACK_DEBIAN_STEREOD_PACKAGE_CONTROL_EXTRA
  ${package_dir}/stereod/conffiles ${package_dir}/stereod/preinst ${package_dir}/stereod/postinst
  ${package_dir}/stereod/prerm ${package_dir}/stereod/postrm)

set(CPACK_DEBIAN_STEREO-CALIBRATE_PACKAGE_NAME stereo-calibrate)
set(CPACK_DEBIAN_STEREO-CALIBRATE_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_STEREO-CALIBRATE_PACKAGE_SUGGESTS stereod)
set(CPACK_COMPONENT_STEREO-CALIBRATE_DESCRIPTION "calibration of two cameras for stereod
Calibrates a pair of cameras from a printed chessboard, live with guidance or
from images, reports how good the result is, and imports and exports
calibrations of ROS, OpenCV and Kalibr. May live on another machine than
stereod.")

set(CPACK_DEBIAN_LIBSTEREOD-DEV_PACKAGE_NAME libstereod-dev)
set(CPACK_DEBIAN_LIBSTEREOD-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBSTEREOD-DEV_PACKAGE_DEPENDS liblcm-dev)
set(CPACK_COMPONENT_LIBSTEREOD-DEV_DESCRIPTION "development files for receivers of stereod's messages
A client library that makes frames, depth and points of stereod's messages,
the LCM types of the messages and the C++ classes made of them, and what CMake
(find_package(stereod)) and pkg-config need to find them.")
include(CPack)
