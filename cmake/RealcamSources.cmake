# The sources of each library: one folder, one library, but for io. CONFIGURE_DEPENDS notices a file that is added or
# removed.
macro(realcam_sources variable folder)
  file(GLOB ${variable} CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cpp/${folder}/*.cpp
       ${PROJECT_SOURCE_DIR}/cpp/${folder}/*.cu)
  list(APPEND all_sources ${variable})
endmacro()

set(all_sources "")

realcam_sources(REALCAM_IO_SOURCES io)
realcam_sources(REALCAM_IMAGE_IO_SOURCES image_io)
realcam_sources(REALCAM_EMBREE_SOURCES embree)
realcam_sources(REALCAM_SHOT_SOURCES shot)
realcam_sources(REALCAM_APP_SOURCES app)
realcam_sources(REALCAM_BINDINGS_SOURCES bindings)
realcam_sources(REALCAM_PICTURE_BINDINGS_SOURCES picture_bindings)
realcam_sources(REALCAM_BVH_SOURCES bvh)
realcam_sources(REALCAM_CUDA_SOURCES cuda)
realcam_sources(REALCAM_DEVICES_SOURCES devices)

# The readers of lens files and glasses are a library of their own, so that who uses lenses needs nothing that reads
# scenes.
set(REALCAM_LENS_IO_SOURCES ${REALCAM_IO_SOURCES})
list(FILTER REALCAM_LENS_IO_SOURCES INCLUDE REGEX "/(lens_[a-z_]+|json|glass_catalogue|nearest_names|printable|readable_file|regular_file|free_memory)\\.cpp$")
list(REMOVE_ITEM REALCAM_IO_SOURCES ${REALCAM_LENS_IO_SOURCES})

# Built once for each instruction set, see RealcamInstructionSets.cmake.
list(FILTER REALCAM_EMBREE_SOURCES EXCLUDE REGEX "/kernels\\.cpp$")

if(REALCAM_LENSES_ONLY)
  foreach(sources IN LISTS all_sources)
    set(${sources} "")
  endforeach()
endif()
if(NOT REALCAM_PYTHON)
  set(REALCAM_BINDINGS_SOURCES "")
  set(REALCAM_PICTURE_BINDINGS_SOURCES "")
endif()
if(NOT REALCAM_OPENIMAGEIO)
  set(REALCAM_IMAGE_IO_SOURCES "")
  set(REALCAM_PICTURE_BINDINGS_SOURCES "")
  set(REALCAM_APP_SOURCES "")
endif()

if(REALCAM_CUDA STREQUAL OFF)
  set(REALCAM_CUDA_SOURCES "")
elseif(REALCAM_CUDA_SOURCES)
  include(CheckLanguage)
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
      # Turing to Blackwell; the last entry carries PTX too, for chips that come later.
      set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 86-real 89-real 90-real 100-real 120)
    endif()
    enable_language(CUDA)
    find_package(CUDAToolkit REQUIRED)
    # CMake 3.25.1, of Debian 12, does not know that nvcc has C++20.
    if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
      set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
      set(CMAKE_CUDA20_COMPILE_FEATURES cuda_std_20)
      list(APPEND CMAKE_CUDA_COMPILE_FEATURES cuda_std_20)
    endif()
    set(CMAKE_CUDA_STANDARD 20)
    set(CMAKE_CUDA_STANDARD_REQUIRED ON)
    set(CMAKE_CUDA_EXTENSIONS OFF)
  elseif(REALCAM_CUDA STREQUAL AUTO)
    set(REALCAM_CUDA_SOURCES "")
  else()
    message(FATAL_ERROR "REALCAM_CUDA is ON, and no CUDA compiler was found: set CMAKE_CUDA_COMPILER or the PATH.")
  endif()
endif()
