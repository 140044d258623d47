# Fuzz targets (tests/fuzz). clang has libFuzzer: a program for each target, realcam_fuzz the one for the trace. Other
# compilers get one driver for all of them. The tests run the same targets for a few seconds.
if(TARGET realcam_embree AND TARGET realcam_io)
  file(GLOB fuzz_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/fuzz_*.cpp)
  set(fuzz_libraries realcam_optics realcam_settings realcam_io realcam_embree)

  # toml++ 3.3 takes its table of blanks for complete: a letter such as U+00E9 beside a key reaches a branch that it marks
  # as unreachable, and is no blank there either.
  if(REALCAM_SANITIZE)
    set_source_files_properties(${PROJECT_SOURCE_DIR}/cpp/io/lens_file.cpp TARGET_DIRECTORY realcam_lens_io
      PROPERTIES COMPILE_OPTIONS -fno-sanitize=unreachable)
  endif()

  add_library(realcam_fuzz_targets OBJECT ${fuzz_sources})
  target_link_libraries(realcam_fuzz_targets PUBLIC ${fuzz_libraries})
  # The core as the kernels have it: its lane loops are ten times slower without these.
  target_compile_options(realcam_fuzz_targets PRIVATE ${REALCAM_KERNEL_FLAGS})

  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND NOT APPLE)
    foreach(source IN LISTS fuzz_sources)
      get_filename_component(name ${source} NAME_WE)
      string(REPLACE "fuzz_lens_trace" "fuzz" name ${name})
      add_executable(realcam_${name} ${source})
      target_link_libraries(realcam_${name} PRIVATE ${fuzz_libraries})
      target_compile_definitions(realcam_${name} PRIVATE REALCAM_LIBFUZZER)
      target_compile_options(realcam_${name} PRIVATE -fsanitize=fuzzer)
      target_link_options(realcam_${name} PRIVATE -fsanitize=fuzzer)
    endforeach()
  else()
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
