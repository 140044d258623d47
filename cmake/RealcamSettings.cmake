# Compiler settings of the project's own targets. Nothing here reaches a project that uses realcam::optics.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
# The static libraries end up in the Python extension.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_CUDA_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  set(CMAKE_CUDA_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

add_library(realcam_settings INTERFACE)
target_compile_definitions(realcam_settings INTERFACE REALCAM_VERSION="${PROJECT_VERSION}")

# -Wconversion is left out: in code templated on float, double and lanes it reports every literal.
set(warnings -Wall -Wextra -Wpedantic -Wnon-virtual-dtor -Woverloaded-virtual
    -Wcast-align -Wformat=2 -Wextra-semi -Wundef -Wvla -Wunused)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # A constructor's parameter may have the name of the member that it fills. -Wdouble-promotion finds float code that
  # became double by accident; clang's reports each assignment, too.
  list(APPEND warnings -Wdouble-promotion -Wshadow=local -Wduplicated-cond -Wlogical-op)
  if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # gcc 12 sees overflows in + of a text and a std::string that are not there (its bug 105329).
    list(APPEND warnings -Wno-array-bounds -Wno-stringop-overflow -Wno-restrict)
  endif()
else()
  # Lane loops have & between comparisons, because && would be a branch. Of what is deprecated, clang reports what the
  # headers of gcc 12 use themselves.
  list(APPEND warnings -Wshadow -Wno-bitwise-instead-of-logical -Wno-deprecated-declarations)
endif()
if(REALCAM_WERROR)
  list(APPEND warnings -Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # These come from the optimiser, and change with the compiler's version and flags; they are shown, not enforced.
    list(APPEND warnings -Wno-error=maybe-uninitialized -Wno-error=array-bounds -Wno-error=stringop-overflow
         -Wno-error=restrict)
  endif()
endif()

target_compile_options(realcam_settings INTERFACE
  "$<$<COMPILE_LANGUAGE:CXX>:${warnings};-fopenmp-simd>"
  # Nothing pedantic: what nvcc hands to the host compiler is not.
  "$<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr;-Xcompiler=-Wall,-Wextra,-fopenmp-simd>"
  # Quotients and roots to two units in the last place. Rounded correctly, each would be a subroutine with a branch to
  # it, and kernels a tenth slower. Where the last bit counts, the lens and the BVH, the core has its own (platform.hpp).
  "$<$<COMPILE_LANGUAGE:CUDA>:-prec-div=false;-prec-sqrt=false>")

if(REALCAM_SANITIZE)
  set(sanitize -fsanitize=${REALCAM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_compile_options(realcam_settings INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:${sanitize}>")
  target_link_options(realcam_settings INTERFACE -fsanitize=${REALCAM_SANITIZE})
endif()

# Of code whose loops over lanes are to become vector code.
set(REALCAM_KERNEL_FLAGS -O3 -ffp-contract=fast -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # Jump threading would turn the selects of the lane loops back into branches, and gcc then gives up on vector code:
  # the lens trace runs ten times slower with it.
  list(APPEND REALCAM_KERNEL_FLAGS -fno-thread-jumps)
endif()

# For targets of many files: the headers and templates that they share take longer to compile than what is their own.
function(realcam_compile_in_bundles target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${REALCAM_UNITY})
endfunction()

# Targets exist only where their sources do.
function(realcam_link_if_present target scope)
  foreach(library IN LISTS ARGN)
    if(TARGET ${library})
      target_link_libraries(${target} ${scope} ${library})
    endif()
  endforeach()
endfunction()
