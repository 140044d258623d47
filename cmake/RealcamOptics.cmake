# realcam::optics, the core, and the package that other projects find. What a device runs is in its headers alone; what
# only the host runs is compiled once, into the library. It needs no other library.
include(CMakePackageConfigHelpers)

set(REALCAM_CORE_FOLDERS math optics camera scene render)

# <realcam/...> resolves in the build tree as it does when installed.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/cpp ${PROJECT_BINARY_DIR}/include/realcam SYMBOLIC)

file(GLOB core_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cpp/*.cpp)
foreach(folder IN LISTS REALCAM_CORE_FOLDERS)
  file(GLOB_RECURSE more CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cpp/${folder}/*.cpp)
  list(APPEND core_sources ${more})
endforeach()
add_library(realcam_optics STATIC ${core_sources})
add_library(realcam::optics ALIAS realcam_optics)
set_target_properties(realcam_optics PROPERTIES EXPORT_NAME optics)
target_compile_features(realcam_optics PUBLIC cxx_std_20)
target_link_libraries(realcam_optics PRIVATE $<BUILD_INTERFACE:realcam_settings>)
realcam_compile_in_bundles(realcam_optics)
# Optimised for several machines, which takes many times as long to compile and is of no use for debugging.
set(lane_sources adjoint_path.cpp outline_rays.cpp tangent_path.cpp)
list(TRANSFORM lane_sources PREPEND ${PROJECT_SOURCE_DIR}/cpp/optics/derivatives/)
set_source_files_properties(${lane_sources} PROPERTIES
  COMPILE_OPTIONS "$<$<NOT:$<CONFIG:Debug>>:${REALCAM_KERNEL_FLAGS}>")
# For this machine alone, one version of them is enough (cpp/optics/derivatives/dual.hpp).
if(REALCAM_INSTRUCTION_SETS STREQUAL machine)
  if(realcam_instruction_sets STREQUAL v4)
    target_compile_definitions(realcam_optics PRIVATE REALCAM_CLONE="avx512f")
  elseif(realcam_instruction_sets STREQUAL v3)
    target_compile_definitions(realcam_optics PRIVATE REALCAM_CLONE="avx2")
  endif()
endif()
target_include_directories(realcam_optics PUBLIC
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
install(TARGETS realcam_optics EXPORT realcamTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT optics)
install(EXPORT realcamTargets NAMESPACE realcam:: DESTINATION ${realcam_package_folder} COMPONENT optics)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/realcamConfig.cmake.in
  ${PROJECT_BINARY_DIR}/realcamConfig.cmake INSTALL_DESTINATION ${realcam_package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/realcamConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/realcamConfig.cmake ${PROJECT_BINARY_DIR}/realcamConfigVersion.cmake
  DESTINATION ${realcam_package_folder} COMPONENT optics)
