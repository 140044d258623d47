# Fuzz targets (tests/fuzz). clang has libFuzzer: a program for each target, realcam_fuzz the one for the trace. Other
# compilers get one driver for all of them. The tests run the same targets for a few seconds.
if(TARGET realcam_embree AND TARGET realcam_io)
  file(GLOB fuzz_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/fuzz_*.cpp)
  set(fuzz_file_sources ${fuzz_sources})
  list(FILTER fuzz_file_sources INCLUDE REGEX "/fuzz_(scene_file|shot_file|picture)\\.cpp$")
  list(REMOVE_ITEM fuzz_sources ${fuzz_file_sources})
  set(fuzz_libraries realcam_optics realcam_settings realcam_io realcam_embree)

  # toml++ 3.3 takes its table of blanks for complete: a letter such as U+00E9 beside a key reaches a branch that it marks
  # as unreachable, and is no blank there either.
  if(REALCAM_SANITIZE)
    set_source_files_properties(${PROJECT_SOURCE_DIR}/cpp/io/text/toml_document.cpp TARGET_DIRECTORY realcam_lens_io
      PROPERTIES COMPILE_OPTIONS -fno-sanitize=unreachable)
  endif()

  add_library(realcam_fuzz_targets OBJECT ${fuzz_sources})
  target_link_libraries(realcam_fuzz_targets PUBLIC ${fuzz_libraries})
  # The core as the kernels have it: its lane loops are ten times slower without these.
  target_compile_options(realcam_fuzz_targets PRIVATE ${REALCAM_KERNEL_FLAGS})

  # Files that may need more than the C library. Pictures have a library of targets for themselves, because a program with
  # OpenImageIO loads 250 others when it starts.
  set(fuzz_file_libraries realcam_optics realcam_settings realcam_io)
  set(fuzz_file_definitions REALCAM_FUZZ_FILES)
  list(FILTER fuzz_file_sources EXCLUDE REGEX "/fuzz_picture\\.cpp$")
  if(TARGET realcam_shot)
    list(APPEND fuzz_file_libraries realcam_shot)
    list(APPEND fuzz_file_definitions REALCAM_FUZZ_SHOT_FILES)
  else()
    list(FILTER fuzz_file_sources EXCLUDE REGEX "/fuzz_shot_file\\.cpp$")
  endif()
  add_library(realcam_fuzz_file_targets OBJECT ${fuzz_file_sources})
  target_link_libraries(realcam_fuzz_file_targets PUBLIC ${fuzz_file_libraries} PRIVATE realcam_mesh_codecs)
  target_compile_definitions(realcam_fuzz_file_targets PUBLIC ${fuzz_file_definitions})
  if(TARGET realcam_openimageio)
    add_library(realcam_fuzz_picture_targets OBJECT fuzz/fuzz_picture.cpp)
    target_link_libraries(realcam_fuzz_picture_targets PUBLIC realcam_settings realcam_io realcam_openimageio)
    list(APPEND fuzz_file_sources fuzz/fuzz_picture.cpp)
    list(APPEND fuzz_file_libraries realcam_openimageio)
    list(APPEND fuzz_file_definitions REALCAM_FUZZ_PICTURES)
  endif()

  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND NOT APPLE)
    # A program for each source.
    function(realcam_add_libfuzzer_programs libraries)
      foreach(source IN LISTS ARGN)
        get_filename_component(name ${source} NAME_WE)
        string(REPLACE "fuzz_lens_trace" "fuzz" name ${name})
        add_executable(realcam_${name} ${source})
        target_link_libraries(realcam_${name} PRIVATE ${libraries})
        target_compile_definitions(realcam_${name} PRIVATE REALCAM_LIBFUZZER)
        target_compile_options(realcam_${name} PRIVATE -fsanitize=fuzzer)
        target_link_options(realcam_${name} PRIVATE -fsanitize=fuzzer)
      endforeach()
    endfunction()
    realcam_add_libfuzzer_programs("${fuzz_libraries}" ${fuzz_sources})
    realcam_add_libfuzzer_programs("${fuzz_file_libraries}" ${fuzz_file_sources})
  else()
    add_executable(realcam_fuzz_files fuzz/main.cpp)
    realcam_link_if_present(realcam_fuzz_files PRIVATE realcam_fuzz_file_targets realcam_fuzz_picture_targets
                            ${fuzz_file_libraries})
    target_compile_definitions(realcam_fuzz_files PRIVATE ${fuzz_file_definitions})
    add_executable(realcam_fuzz fuzz/main.cpp fuzz/no_scene.cpp $<TARGET_OBJECTS:realcam_fuzz_targets>)
    target_link_libraries(realcam_fuzz PRIVATE ${fuzz_libraries} realcam::embree)
    # It needs nothing but the C library, so that a copy runs on whatever machine has many cores.
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT APPLE)
      target_link_options(realcam_fuzz PRIVATE -Wl,--as-needed -static-libgcc -static-libstdc++)
      if(REALCAM_SANITIZE)
        target_link_options(realcam_fuzz PRIVATE -static-libasan -static-libubsan)
      endif()
    endif()
  endif()
endif()
