cmake_minimum_required(VERSION 3.25)

# Writes OUTPUT, a C++ source with the stamp of the headers in LIST, which are named from FOLDER on.
file(STRINGS ${LIST} headers)
set(hashes "")
foreach(header IN LISTS headers)
  file(SHA256 ${FOLDER}/${header} hash)
  string(APPEND hashes "${header} ${hash}\n")
endforeach()
string(SHA256 build "${hashes}")
string(SUBSTRING ${build} 0 12 build)
file(WRITE ${OUTPUT} "// Generated from the headers in ${LIST}.
namespace realcam {

const char* cuda_backend_stamp() {
    return \"${VERSION} (build ${build})\";
}

}  // namespace realcam
")
