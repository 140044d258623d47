cmake_minimum_required(VERSION 3.25)

# Writes OUTPUT, a C++ source with the text of every file named in LIST, as the function bundled_KIND_files() of HEADER
# gives them. Arrays of numbers, because compilers limit the length of a string literal and a file may hold any delimiter.
file(STRINGS ${LIST} paths)

set(arrays "")
set(entries "")
set(glass "")
if(KIND STREQUAL "lens")
  set(glass "
std::string_view bundled_glass_catalogue() {
    return {};
}
")
endif()
set(index 0)
foreach(path IN LISTS paths)
  get_filename_component(name ${path} NAME_WLE)
  file(READ ${path} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(REGEX REPLACE "(0x0a,)" "\\1\n    " bytes "${bytes}")
  string(APPEND arrays "constexpr unsigned char file_${index}[] = {\n    ${bytes}0x00};\n\n")
  if(name STREQUAL "glass")
    set(glass "
std::string_view bundled_glass_catalogue() {
    return text_of(file_${index});
}
")
  else()
    string(APPEND entries "        {\"${name}\", text_of(file_${index})},\n")
  endif()
  math(EXPR index "${index} + 1")
endforeach()

file(WRITE ${OUTPUT} "// Generated from the files in ${LIST}.
#include <cstddef>
#include <vector>

#include \"${HEADER}\"

namespace realcam::io {
namespace {

${arrays}// Less the closing zero, which keeps the array of an empty file legal.
template <std::size_t Size>
[[maybe_unused]] std::string_view text_of(const unsigned char (&bytes)[Size]) {
    return {reinterpret_cast<const char*>(bytes), Size - 1};
}

}  // namespace

std::span<const BundledFile> bundled_${KIND}_files() {
    static const std::vector<BundledFile> files{
${entries}    };
    return files;
}
${glass}
}  // namespace realcam::io
")
