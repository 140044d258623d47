# realcam::optics, the header-only core, and the package that other projects find.
include(CMakePackageConfigHelpers)

set(REALCAM_CORE_FOLDERS math optics camera scene render)

# <realcam/...> resolves in the build tree as it does when installed.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/cpp ${PROJECT_BINARY_DIR}/include/realcam SYMBOLIC)

add_library(realcam_optics INTERFACE)
add_library(realcam::optics ALIAS realcam_optics)
set_target_properties(realcam_optics PROPERTIES EXPORT_NAME optics)
target_compile_features(realcam_optics INTERFACE cxx_std_20)
target_include_directories(realcam_optics INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/cpp>
  $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cpp/*.hpp)
install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/realcam COMPONENT optics)
foreach(folder IN LISTS REALCAM_CORE_FOLDERS)
  if(EXISTS ${PROJECT_SOURCE_DIR}/cpp/${folder})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/cpp/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/realcam
            COMPONENT optics FILES_MATCHING PATTERN "*.hpp")
  endif()
endforeach()

set(realcam_package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/realcam)
install(TARGETS realcam_optics EXPORT realcamTargets COMPONENT optics)
install(EXPORT realcamTargets NAMESPACE realcam:: DESTINATION ${realcam_package_folder} COMPONENT optics)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/realcamConfig.cmake.in
  ${PROJECT_BINARY_DIR}/realcamConfig.cmake INSTALL_DESTINATION ${realcam_package_folder})
# Headers serve any processor.
set(any_processor "")
if(REALCAM_HEADERS_ONLY)
  set(any_processor ARCH_INDEPENDENT)
endif()
write_basic_package_version_file(${PROJECT_BINARY_DIR}/realcamConfigVersion.cmake
  COMPATIBILITY SameMinorVersion ${any_processor})
install(FILES ${PROJECT_BINARY_DIR}/realcamConfig.cmake ${PROJECT_BINARY_DIR}/realcamConfigVersion.cmake
  DESTINATION ${realcam_package_folder} COMPONENT optics)
