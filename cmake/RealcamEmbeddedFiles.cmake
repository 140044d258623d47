# Sets `variable` to a generated source with the text of some files, which <header>.hpp declares.
function(realcam_embed_files variable kind header)
  set(name bundled_${kind}_files)
  set(source ${PROJECT_BINARY_DIR}/${name}.cpp)
  # The list goes through a file: as an argument its semicolons would be taken apart. It is part of DEPENDS, so that
  # what is removed also leaves the program.
  set(list ${PROJECT_BINARY_DIR}/${name}.txt)
  list(JOIN ARGN "\n" lines)
  file(CONFIGURE OUTPUT ${list} CONTENT "${lines}\n" @ONLY)
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake)
  add_custom_command(
    OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DLIST=${list} -DOUTPUT=${source} -DKIND=${kind} -DHEADER=${header}.hpp -P ${script}
    DEPENDS ${ARGN} ${list} ${script}
    COMMENT "Embedding the ${kind} files"
    VERBATIM)
  set(${variable} ${source} PARENT_SCOPE)
endfunction()
