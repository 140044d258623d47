#include "devices.hpp"

#include <cstdio>

#include "../embree/embree_backend.hpp"
#include "../error.hpp"
#include "json_writer.hpp"

namespace realcam::app {

std::unique_ptr<Backend> make_backend(const std::string& device) {
    if (device == "auto" || device == "cpu") return make_embree_backend();
    throw InputError("--device: \"" + device +
                     "\" is not known; auto or cpu is wanted (`realcam devices` lists what there is)");
}

void list_devices(bool as_json) {
    const std::string name = make_backend("cpu")->name();
    if (!as_json) {
        std::printf("cpu   %s\n", name.c_str());
        return;
    }
    JsonWriter json;
    json.begin_array().begin_object().key("device").text("cpu").key("name").text(name).end().end();
    std::puts(json.finish().c_str());
}

}  // namespace realcam::app
