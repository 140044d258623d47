# realcam._core, the Python extension.
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)

# pybind11 is most often a Python package, which only its Python knows.
if(NOT DEFINED pybind11_DIR)
  execute_process(COMMAND ${Python_EXECUTABLE} -m pybind11 --cmakedir OUTPUT_VARIABLE pybind11_hint
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
set(PYBIND11_FINDPYTHON ON)
find_package(pybind11 CONFIG QUIET HINTS ${pybind11_hint})
if(NOT pybind11_FOUND)
  message(FATAL_ERROR "The Python extension needs pybind11: ${Python_EXECUTABLE} -m pip install pybind11")
endif()

# Without pybind11's extras: link-time optimisation would merge code built for different instruction sets.
pybind11_add_module(_core MODULE NO_EXTRAS ${REALCAM_BINDINGS_SOURCES})
target_link_libraries(_core PRIVATE realcam_settings)
realcam_link_if_present(_core PRIVATE ${realcam_backends} realcam_image_io realcam_command)
if(TARGET realcam_command)
  target_compile_definitions(_core PRIVATE REALCAM_HAS_PICTURES=1)
endif()
set_target_properties(_core PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/python)
realcam_compile_in_bundles(_core)
install(TARGETS _core LIBRARY DESTINATION realcam COMPONENT python)
install(FILES ${PROJECT_SOURCE_DIR}/scenes/demo.glb ${PROJECT_SOURCE_DIR}/scenes/demo.toml
        DESTINATION realcam/scenes COMPONENT python)

# A link in the source tree serves an editable install. It is renewed with every build, because several build trees may
# take turns.
if(NOT SKBUILD)
  add_custom_target(realcam_core_link ALL COMMENT "Linking the extension into python/realcam")
  add_dependencies(realcam_core_link _core)
  add_custom_command(TARGET realcam_core_link POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E create_symlink $<TARGET_FILE:_core>
            ${PROJECT_SOURCE_DIR}/python/realcam/$<TARGET_FILE_NAME:_core> VERBATIM)
endif()
