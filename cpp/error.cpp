#include "error.hpp"

#include <utility>

namespace realcam {

LensFileError::LensFileError(const std::string& message, std::string file, int line, int surface)
    : Error(location(file, line, surface) + message),
      detail(message),
      file(std::move(file)),
      line(line),
      surface(surface) {}

std::string LensFileError::location(const std::string& file, int line, int surface) {
    std::string where = file;
    if (line > 0) where += (where.empty() ? "line " : ":") + std::to_string(line);
    if (surface > 0) where += (where.empty() ? "surface " : ": surface ") + std::to_string(surface);
    return where.empty() ? where : where + ": ";
}

}  // namespace realcam
