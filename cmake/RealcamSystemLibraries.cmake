# Looks for every system library that the sources at hand need, and names all that are missing in one message.
set(missing "")

macro(realcam_need found what package)
  if(NOT ${found})
    list(APPEND missing "${package}")
    string(APPEND missing_text "\n  ${what}: ${package}")
  endif()
endmacro()

# Used as headers alone; the packages of some systems ask for pkg-config as well.
find_path(TOMLPLUSPLUS_INCLUDE_DIR toml++/toml.h)
realcam_need(TOMLPLUSPLUS_INCLUDE_DIR "toml++, reads lens files" libtomlplusplus-dev)

if(REALCAM_EMBREE_SOURCES)
  find_package(TBB CONFIG QUIET)
  realcam_need(TBB_FOUND "TBB, uses all cores" libtbb-dev)
  # Debian 12 has Embree 3; Debian 13 and Ubuntu 24.04 have Embree 4.
  if(TBB_FOUND)
    find_package(embree 4 CONFIG QUIET)
    if(NOT embree_FOUND)
      find_package(embree 3 CONFIG QUIET)
    endif()
  endif()
  realcam_need(embree_FOUND "Embree 3 or 4, meets the scene" libembree-dev)
  if(embree_FOUND)
    add_library(realcam_embree_library INTERFACE)
    add_library(realcam::embree ALIAS realcam_embree_library)
    target_link_libraries(realcam_embree_library INTERFACE embree)
    target_compile_definitions(realcam_embree_library INTERFACE REALCAM_EMBREE_MAJOR=${EMBREE_VERSION_MAJOR})
  endif()
endif()

if(REALCAM_APP_SOURCES)
  find_package(CLI11 CONFIG QUIET)
  realcam_need(CLI11_FOUND "CLI11, reads the command line" libcli11-dev)
endif()

if(REALCAM_TESTS)
  find_package(doctest CONFIG QUIET)
  realcam_need(doctest_FOUND "doctest, runs the C++ tests" doctest-dev)
  find_package(Boost QUIET)
  realcam_need(Boost_FOUND "Boost (headers), many-digit numbers and statistics of the C++ tests" libboost-dev)
endif()

if(REALCAM_IMAGE_IO_SOURCES)
  find_package(PNG QUIET)
  realcam_need(PNG_FOUND "libpng, reads PNG" libpng-dev)
endif()

# OpenImageIO's own CMake package asks for command-line tools and codecs that nothing here uses, and stops the
# configuration where they are absent; the header and the library are enough.
if(REALCAM_OPENIMAGEIO_SOURCES)
  find_path(OPENIMAGEIO_INCLUDE_DIR OpenImageIO/imageio.h)
  find_library(OPENIMAGEIO_LIBRARY OpenImageIO)
  find_library(OPENIMAGEIO_UTIL_LIBRARY OpenImageIO_Util)
  if(OPENIMAGEIO_INCLUDE_DIR AND OPENIMAGEIO_LIBRARY)
    set(OPENIMAGEIO_FOUND TRUE)
    add_library(realcam_openimageio_library INTERFACE)
    add_library(realcam::openimageio ALIAS realcam_openimageio_library)
    target_include_directories(realcam_openimageio_library SYSTEM INTERFACE ${OPENIMAGEIO_INCLUDE_DIR})
    target_link_libraries(realcam_openimageio_library INTERFACE ${OPENIMAGEIO_LIBRARY})
    if(OPENIMAGEIO_UTIL_LIBRARY)
      target_link_libraries(realcam_openimageio_library INTERFACE ${OPENIMAGEIO_UTIL_LIBRARY})
    endif()
  endif()
  realcam_need(OPENIMAGEIO_FOUND
    "OpenImageIO, picture files of the executable (-DREALCAM_OPENIMAGEIO=OFF: no executable)" libopenimageio-dev)
endif()

if(missing)
  list(JOIN missing " " missing)
  message(FATAL_ERROR "realcam needs libraries that are not on this system (with their Debian and Ubuntu packages):"
    "${missing_text}\nOn Debian 12 or later and Ubuntu 24.04 or later:\n  apt-get install ${missing}\n")
endif()
