cmake_minimum_required(VERSION 3.25)

# Builds each part of realcam as docs/cpp.md says, installs it into an empty prefix, then configures, builds and runs the
# consumer of that part against it. The build of realcam is kept, so that the next one compiles what has changed; and
# both parts have the same one, so that the second compiles what the first has not.
set(run COMMAND_ERROR_IS_FATAL ANY)
set(compiler --no-warn-unused-cli -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER})
# Neither a package that another build registered, nor what else the machine has, may stand in for what is missing.
set(alone -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
foreach(library IN ITEMS assimp embree TBB CLI11 OpenImageIO CUDAToolkit Python tomlplusplus)
  list(APPEND alone -DCMAKE_DISABLE_FIND_PACKAGE_${library}=ON)
endforeach()
# Debug: what is tested is that it builds and what it answers.
list(APPEND alone -DCMAKE_BUILD_TYPE=Debug)

function(install_part part optics_only lenses_only)
  file(REMOVE_RECURSE ${WORK}/${part}/prefix ${WORK}/${part}/build)
  execute_process(COMMAND ${CMAKE_COMMAND} ${compiler} ${alone} -S ${REALCAM} -B ${WORK}/realcam
                          -DREALCAM_OPTICS_ONLY=${optics_only} -DREALCAM_LENSES_ONLY=${lenses_only}
                  OUTPUT_QUIET ${run})
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/realcam OUTPUT_QUIET ${run})
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${WORK}/realcam --prefix ${WORK}/${part}/prefix OUTPUT_QUIET ${run})
endfunction()

# The rest of its arguments are those of execute_process.
function(configure_consumer part prefix build)
  execute_process(COMMAND ${CMAKE_COMMAND} ${compiler} ${alone} -S ${CONSUMER} -B ${build} -DPART=${part}
                          -DCMAKE_PREFIX_PATH=${prefix}
                  ${ARGN})
  return(PROPAGATE message status)
endfunction()

foreach(part_and_options IN ITEMS "io;OFF;ON" "optics;ON;OFF")
  list(POP_FRONT part_and_options part optics_only lenses_only)
  install_part(${part} ${optics_only} ${lenses_only})
  configure_consumer(${part} ${WORK}/${part}/prefix ${WORK}/${part}/build ${run})
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/${part}/build ${run})
  execute_process(COMMAND ${WORK}/${part}/build/consumer ${run})
endforeach()

if(NOT EXISTS ${WORK}/io/prefix/share/realcam/lenses/double-gauss-100mm.toml)
  message(FATAL_ERROR "the lens files were not installed")
endif()

# Who asks for a part that was not installed is told so.
file(REMOVE_RECURSE ${WORK}/refused)
configure_consumer(io ${WORK}/optics/prefix ${WORK}/refused OUTPUT_QUIET ERROR_VARIABLE message RESULT_VARIABLE status)
if(status EQUAL 0 OR NOT message MATCHES "REALCAM_LENSES_ONLY")
  message(FATAL_ERROR "realcam::io was found, or the message does not say how to install it: ${message}")
endif()
