# realcam_cuda_stamp defines cuda_backend_stamp (cpp/cuda/cuda_backend.hpp): the version, and a number made of all headers, because classes
# cross the border between realcam and the plug-in as their headers have them.
file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR}/cpp CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cpp/*.hpp)
list(TRANSFORM headers PREPEND ${PROJECT_SOURCE_DIR}/cpp/ OUTPUT_VARIABLE header_paths)
set(source ${PROJECT_BINARY_DIR}/cuda_backend_stamp.cpp)
list(JOIN headers "\n" lines)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/cuda_backend_headers.txt CONTENT "${lines}\n" @ONLY)
add_custom_command(
  OUTPUT ${source}
  COMMAND ${CMAKE_COMMAND} -DLIST=${PROJECT_BINARY_DIR}/cuda_backend_headers.txt -DFOLDER=${PROJECT_SOURCE_DIR}/cpp
          -DVERSION=${PROJECT_VERSION} -DOUTPUT=${source} -P ${PROJECT_SOURCE_DIR}/cmake/cuda_stamp.cmake
  DEPENDS ${header_paths} ${PROJECT_BINARY_DIR}/cuda_backend_headers.txt ${PROJECT_SOURCE_DIR}/cmake/cuda_stamp.cmake
  COMMENT "Making the stamp of the CUDA backend"
  VERBATIM)
add_library(realcam_cuda_stamp STATIC ${source})
target_link_libraries(realcam_cuda_stamp PRIVATE realcam_settings)
