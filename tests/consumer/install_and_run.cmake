cmake_minimum_required(VERSION 3.25)

# Builds one part of realcam as docs/cpp.md says (OPTION), installs it into an empty prefix, then configures, builds and runs
# the consumer of that PART against it. The build of realcam is kept, so that the next one compiles what has changed.
file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/build ${WORK}/refused)
set(run COMMAND_ERROR_IS_FATAL ANY)
set(compiler --no-warn-unused-cli -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER})
# Neither a package that another build registered, nor what else the machine has, may stand in for what is missing.
set(alone -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
foreach(library IN ITEMS assimp embree TBB CLI11 OpenImageIO CUDAToolkit Python tomlplusplus)
  list(APPEND alone -DCMAKE_DISABLE_FIND_PACKAGE_${library}=ON)
endforeach()

execute_process(COMMAND ${CMAKE_COMMAND} ${compiler} ${alone} -S ${REALCAM} -B ${WORK}/realcam -D${OPTION}=ON -DCMAKE_BUILD_TYPE=Debug -DCMAKE_UNITY_BUILD=ON
                OUTPUT_QUIET ${run})
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/realcam OUTPUT_QUIET ${run})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${WORK}/realcam --prefix ${WORK}/prefix OUTPUT_QUIET ${run})

# Debug: what is tested is that it builds and what it answers.
set(consumer ${compiler} ${alone} -S ${CONSUMER} -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=Debug)
execute_process(COMMAND ${CMAKE_COMMAND} ${consumer} -B ${WORK}/build -DPART=${PART} ${run})
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/build ${run})
execute_process(COMMAND ${WORK}/build/consumer ${run})

if(PART STREQUAL optics)
  # Who asks for a part that was not installed is told so.
  execute_process(COMMAND ${CMAKE_COMMAND} ${consumer} -B ${WORK}/refused -DPART=io
                  OUTPUT_QUIET ERROR_VARIABLE message RESULT_VARIABLE status)
  if(status EQUAL 0 OR NOT message MATCHES "REALCAM_LENSES_ONLY")
    message(FATAL_ERROR "realcam::io was found, or the message does not say how to install it: ${message}")
  endif()
elseif(NOT EXISTS ${WORK}/prefix/share/realcam/lenses/double-gauss-100mm.toml)
  message(FATAL_ERROR "the lens files were not installed")
endif()
