# Embeds lenses/*.toml, so that a lens is found by its name wherever the program or the extension is.
file(GLOB lens_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lenses/*.toml)
set(REALCAM_LENS_FILES_SOURCE ${PROJECT_BINARY_DIR}/bundled_lenses.cpp)

# The list goes through a file: as an argument its semicolons would be taken apart. It is part of DEPENDS, so that
# a lens that is removed also leaves the program.
list(JOIN lens_files "\n" lens_file_lines)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/bundled_lenses.txt CONTENT "${lens_file_lines}\n" @ONLY)

add_custom_command(
  OUTPUT ${REALCAM_LENS_FILES_SOURCE}
  COMMAND ${CMAKE_COMMAND} -DLIST=${PROJECT_BINARY_DIR}/bundled_lenses.txt -DOUTPUT=${REALCAM_LENS_FILES_SOURCE}
          -P ${CMAKE_CURRENT_LIST_DIR}/embed_lens_files.cmake
  DEPENDS ${lens_files} ${PROJECT_BINARY_DIR}/bundled_lenses.txt ${CMAKE_CURRENT_LIST_DIR}/embed_lens_files.cmake
  COMMENT "Embedding the lens files"
  VERBATIM)
