#include "devices.hpp"

#include <cstdio>

#include "../cuda/cuda_devices.hpp"
#include "../devices/devices.hpp"
#include "../io/text/json_writer.hpp"
#include "../io/text/one_line.hpp"

namespace realcam::app {

void list_devices(bool as_json) {
    const std::vector<Device> list = devices();
    if (!as_json) {
        for (const Device& device : list) std::printf("%-7s %s\n", device.name.c_str(), device.description.c_str());
        std::fflush(stdout);
        if (const std::string why = why_no_cuda_device(); !why.empty())
            std::fprintf(stderr, "realcam: no GPU: %s\n", io::one_line(why).c_str());
        return;
    }
    io::JsonWriter json;
    json.begin_array();
    for (const Device& device : list)
        json.begin_object().key("device").text(device.name).key("name").text(device.description).end();
    json.end();
    std::puts(json.finish().c_str());
}

}  // namespace realcam::app
