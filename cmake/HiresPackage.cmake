# The Debian package ros-hires, which scripts/package makes: what only an installed system has, and what
# CPack has to know.

# Man pages from what the program says of itself.
set(pages ${PROJECT_BINARY_DIR}/man)
add_custom_command(OUTPUT ${pages}/hires.1
  COMMAND ${CATKIN_DEVEL_PREFIX}/env.sh ${PROJECT_SOURCE_DIR}/packaging/man_pages
    $<TARGET_FILE:hires_hires_node> ${PROJECT_VERSION} ${pages}
  DEPENDS hires_hires_node packaging/man_pages VERBATIM)
add_custom_target(hires_man_pages ALL DEPENDS ${pages}/hires.1)
install(DIRECTORY ${pages}/ DESTINATION share/man/man1 FILES_MATCHING PATTERN "*.1")
install(FILES packaging/hires.bash DESTINATION share/bash-completion/completions RENAME hires)
install(FILES packaging/hires-imagination.service DESTINATION lib/systemd/system)
install(FILES LICENSE DESTINATION share/doc/ros-hires RENAME copyright)
install(FILES README.md CHANGELOG.rst DESTINATION share/doc/ros-hires)
install(DIRECTORY docs DESTINATION share/doc/ros-hires)
install(DIRECTORY examples DESTINATION share/doc/ros-hires USE_SOURCE_PERMISSIONS)

# What is started or imported; what is linked finds dpkg-shlibdeps.
execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/setup --list run
  OUTPUT_VARIABLE depends OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "scripts/setup --list run failed, which tells what the package depends on")
endif()
string(REPLACE "\n" ", " CPACK_DEBIAN_PACKAGE_DEPENDS "${depends}")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ros-hires)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "rviz, ros-robot-state-publisher, python3-tf2-ros, python3-yaml")
set(CPACK_PACKAGE_CONTACT "${hires_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "robots that imagine an action in physics before they do it")
set(CPACK_PACKAGE_DESCRIPTION "Plays ways to do an action many times in physics, with all that is uncertain drawn
at random, and ranks them: how often it went well and how sure that is, how
long it takes, what went wrong. A ROS 1 package with nodes, the program hires,
a library and a Python module.")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
