# Every header of the core compiles alone as C++, and as CUDA where nvcc is on the machine. The checks are targets
# outside of `all`, which ctest builds; ninja then runs them in parallel and repeats only what a change concerns.
file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cpp/*.hpp)
foreach(folder IN LISTS REALCAM_CORE_FOLDERS)
  file(GLOB_RECURSE more CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cpp/${folder}/*.hpp)
  list(APPEND headers ${more})
endforeach()

function(write_includes source headers)
  list(TRANSFORM headers REPLACE "(.+)" "#include \"\\1\"\n")
  list(JOIN headers "" includes)
  file(CONFIGURE OUTPUT ${source} CONTENT "${includes}" @ONLY)
endfunction()

set(cxx_sources "")
foreach(header IN LISTS headers)
  file(RELATIVE_PATH relative ${PROJECT_SOURCE_DIR}/cpp ${header})
  string(REPLACE "/" "_" name ${relative})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.cpp)
  # Twice: a header without its guard fails too.
  file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${relative}\"\n#include \"${relative}\"\n" @ONLY)
  list(APPEND cxx_sources ${source})
endforeach()

# All in one file, too, with those that one program links and no other library is needed for: two that define one name
# would disturb each other there.
set(all_headers ${headers})
foreach(folder IN ITEMS bvh devices io plan shot)
  file(GLOB_RECURSE more CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cpp/${folder}/*.hpp)
  list(APPEND all_headers ${more})
endforeach()
set(source ${CMAKE_CURRENT_BINARY_DIR}/headers/all_headers.cpp)
write_includes(${source} "${all_headers}")
list(APPEND cxx_sources ${source})

# nvcc takes two seconds for each file, most of them for headers that all of them include. That a header includes what
# it needs is known from C++, so that it may stand behind others here.
find_program(NVCC_PROGRAM nvcc PATHS /usr/local/cuda/bin)
set(cuda_stamps "")
if(NVCC_PROGRAM)
  list(LENGTH headers count)
  math(EXPR last "${count} - 1")
  foreach(begin RANGE 0 ${last} 24)
    list(SUBLIST headers ${begin} 24 bundle)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/headers/cuda_${begin}.cu)
    set(stamp ${CMAKE_CURRENT_BINARY_DIR}/headers/cuda_${begin}.ptx)
    write_includes(${source} "${bundle}")
    # PTX: both passes of nvcc's front end, and neither the assembler nor the host compiler's back end.
    add_custom_command(OUTPUT ${stamp}
      COMMAND ${NVCC_PROGRAM} -std=c++20 --expt-relaxed-constexpr -arch=sm_90 -ptx -ccbin ${CMAKE_CXX_COMPILER}
              -MD -MF ${stamp}.d -MT ${stamp} -o ${stamp} ${source}
      DEPENDS ${source} DEPFILE ${stamp}.d COMMENT "CUDA: headers from ${begin}" VERBATIM)
    list(APPEND cuda_stamps ${stamp})
  endforeach()
endif()

if(cxx_sources)
  add_library(realcam_headers OBJECT EXCLUDE_FROM_ALL ${cxx_sources})
  target_link_libraries(realcam_headers PRIVATE realcam_optics realcam_settings)
  add_test(NAME build/headers_cxx COMMAND ${CMAKE_COMMAND} --build ${PROJECT_BINARY_DIR} --target realcam_headers)
  # Two builds in one tree would disturb each other.
  set_tests_properties(build/headers_cxx PROPERTIES RUN_SERIAL ON LABELS build)
endif()
if(cuda_stamps)
  add_custom_target(realcam_headers_cuda DEPENDS ${cuda_stamps})
  add_test(NAME build/headers_cuda COMMAND ${CMAKE_COMMAND} --build ${PROJECT_BINARY_DIR} --target realcam_headers_cuda)
  set_tests_properties(build/headers_cuda PROPERTIES RUN_SERIAL ON LABELS build)
endif()
