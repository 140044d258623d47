# Builds one source once for each instruction set; the program chooses at run time. REALCAM_ISA names the inline
# namespace that the core then lives in (cpp/platform.hpp), so that the builds share no symbol.
# REALCAM_INSTRUCTION_SETS is the choice: every one of them runs on any machine that a package may land on, and takes its
# share of the build; `machine` is the widest that the processor at hand has.
set(REALCAM_INSTRUCTION_SETS v2 v3 v4 CACHE STRING "On x86: which of v2, v3, v4 (x86-64-v2 ...) to build, or machine")

# Asked anew at each configuration: the build folder may stand on another machine than the last time.
function(realcam_widest_instruction_set variable)
  unset(REALCAM_MACHINE_LEVEL CACHE)
  try_run(REALCAM_MACHINE_LEVEL compiles SOURCE_FROM_CONTENT level.cpp [[
    int main() {
        return __builtin_cpu_supports("x86-64-v4") ? 4 : __builtin_cpu_supports("x86-64-v3") ? 3 : 2;
    }]])
  if(NOT compiles)
    message(FATAL_ERROR "The compiler cannot ask for a processor's instruction set: gcc 12 or clang 18 is required.")
  endif()
  set(${variable} v${REALCAM_MACHINE_LEVEL} PARENT_SCOPE)
endfunction()

# Those that are built.
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set(realcam_instruction_sets native)
elseif(REALCAM_INSTRUCTION_SETS STREQUAL machine)
  realcam_widest_instruction_set(realcam_instruction_sets)
else()
  set(realcam_instruction_sets ${REALCAM_INSTRUCTION_SETS})
  list(SORT realcam_instruction_sets)
endif()

function(realcam_add_instruction_sets target source)
  if(NOT EXISTS ${PROJECT_SOURCE_DIR}/${source})
    return()
  endif()
  list(TRANSFORM realcam_instruction_sets REPLACE "(.+)" "SET(\\1)" OUTPUT_VARIABLE sets)
  string(REPLACE ";" " " sets "${sets}")
  set_property(SOURCE cpp/embree/kernels_dispatch.cpp APPEND PROPERTY COMPILE_DEFINITIONS "REALCAM_INSTRUCTION_SETS=${sets}")
  foreach(name IN LISTS realcam_instruction_sets)
    set(object ${target}_${name})
    add_library(${object} OBJECT ${source})
    target_compile_definitions(${object} PRIVATE REALCAM_ISA=${name})
    target_link_libraries(${object} PRIVATE realcam_optics realcam_settings realcam::embree)
    target_compile_options(${object} PRIVATE ${REALCAM_KERNEL_FLAGS})
    if(NOT name STREQUAL native)
      target_compile_options(${object} PRIVATE -march=x86-64-${name})
    endif()
    if(name STREQUAL v4)
      target_compile_options(${object} PRIVATE -mprefer-vector-width=512)
    elseif(name STREQUAL v3)
      target_compile_options(${object} PRIVATE -mprefer-vector-width=256)
    endif()
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${object}>)
    set_property(GLOBAL APPEND PROPERTY REALCAM_KERNEL_OBJECTS ${object})
  endforeach()
endfunction()
