# realcam::io: lens files and the glass catalogue. It is part of the package that other projects find; toml++, which it
# is compiled with, is not.
include(RealcamLensFiles)

add_library(realcam_lens_io STATIC ${REALCAM_LENS_IO_SOURCES} ${REALCAM_LENS_FILES_SOURCE})
add_library(realcam::io ALIAS realcam_lens_io)
set_target_properties(realcam_lens_io PROPERTIES EXPORT_NAME io)
target_link_libraries(realcam_lens_io PUBLIC realcam_optics PRIVATE $<BUILD_INTERFACE:realcam_settings>)
realcam_compile_in_bundles(realcam_lens_io)
target_include_directories(realcam_lens_io SYSTEM PRIVATE ${TOMLPLUSPLUS_INCLUDE_DIR})

install(TARGETS realcam_lens_io EXPORT realcamIoTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT io)
install(EXPORT realcamIoTargets NAMESPACE realcam:: DESTINATION ${realcam_package_folder} COMPONENT io)
install(FILES ${PROJECT_SOURCE_DIR}/cpp/io/lens/lens_file.hpp ${PROJECT_SOURCE_DIR}/cpp/io/lens/lens_error.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/realcam/io/lens COMPONENT io)
# The library holds their text; these are for people, who start from one when they write another.
install(FILES ${lens_files} ${PROJECT_SOURCE_DIR}/lenses/README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/realcam/lenses
        COMPONENT io)
