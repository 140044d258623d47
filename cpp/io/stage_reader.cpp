#include "stage_reader.hpp"

#include <utility>

#include "../error.hpp"

namespace realcam::io {
namespace {

StageReader& registered() {
    static StageReader reader;
    return reader;
}

}  // namespace

bool has_stage_reader() {
    return bool(registered().scene);
}

const StageReader& stage_reader(const std::string& path) {
    if (!has_stage_reader())
        throw SceneFileError(path + ": USD stages are read by the Python package only: pip install realcam[usd]");
    return registered();
}

void set_stage_reader(StageReader reader) {
    registered() = std::move(reader);
}

}  // namespace realcam::io
