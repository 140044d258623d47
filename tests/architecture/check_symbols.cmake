cmake_minimum_required(VERSION 3.25)

# Fails where OBJECT, built for the instruction set ISA, holds a weak or unique symbol outside of the namespace of
# that name. The linker keeps one definition of such a symbol for the whole program: it could be this one, and end
# the program on a machine without the instructions.
execute_process(COMMAND ${NM} --defined-only ${OBJECT} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)

string(LENGTH ${ISA} length)
string(REGEX MATCHALL "[^\n]+ [WVu] [^\n]+" shared "${symbols}")
# Written by the compiler for every exception personality: data, the same in each build.
list(FILTER shared EXCLUDE REGEX " DW\\.ref\\.")
list(FILTER shared EXCLUDE REGEX "7realcam${length}${ISA}")

if(shared)
  list(JOIN shared "\n  " shared)
  message(FATAL_ERROR "Weak symbols built for ${ISA} that other code may share:\n  ${shared}\n"
    "Keep standard-library templates and inline functions from outside the core out of the kernels.")
endif()
string(REGEX MATCHALL " [TW] " functions "${symbols}")
if(NOT functions)
  message(FATAL_ERROR "${OBJECT} defines no function: the check would pass for the wrong reason.")
endif()
