// Views and colour conversions of OpenColorIO, which realcam.ocio and realcam.ocio_config provide.

#include "python_view.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstring>
#include <string>
#include <utility>

#include "../../shot/ocio.hpp"
#include "../bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Calls f with the GIL. Errors of realcam become InputErrors, because commands in C++ report them too.
template <class F>
auto call_python(F&& f) {
    const py::gil_scoped_acquire locked;
    try {
        return f();
    } catch (py::error_already_set& error) {
        const py::module_ core = py::module_::import("realcam._core");
        if (error.matches(core.attr("Cancelled"))) throw Cancelled();
        if (error.matches(core.attr("RealcamError"))) throw InputError(path_from(py::str(error.value())));
        throw;
    }
}

/// Python object that C++ code without the GIL may own.
std::shared_ptr<py::object> shared(py::object object) {
    return {new py::object(std::move(object)), [](py::object* owned) {
                const py::gil_scoped_acquire locked;
                delete owned;
            }};
}

/// View whose work is done by a realcam.OcioView.
class PythonView final : public View {
public:
    explicit PythonView(py::object view) : view_(shared(std::move(view))) {}

    void develop(const float* exposure_lux_s, std::size_t count, double iso, std::uint8_t* codes) const override {
        call_python([&] {
            const std::vector<py::ssize_t> shape = {1, static_cast<py::ssize_t>(count), 3};
            const py::array_t<float> pixels(shape, exposure_lux_s);
            const auto developed =
                view_->attr("developed")(pixels, iso).cast<py::array_t<std::uint8_t, py::array::c_style>>();
            if (developed.size() != static_cast<py::ssize_t>(3 * count))
                throw InputError("a view must return three 8-bit values for each pixel");
            std::memcpy(codes, developed.data(), 3 * count);
        });
    }
    std::vector<std::pair<std::string, std::string>> entries() const override {
        return call_python([&] {
            std::vector<std::pair<std::string, std::string>> entries;
            for (const auto& [name, value] : view_->attr("metadata")().cast<py::dict>())
                entries.emplace_back(py::str(name), path_from(py::str(value)));
            return entries;
        });
    }
    bool is_srgb() const override {
        return call_python([&] { return view_->attr("is_srgb").cast<bool>(); });
    }

    const py::object& object() const { return *view_; }

private:
    std::shared_ptr<py::object> view_;
};

/// Configuration whose work is done by a realcam.ocio_config.OcioConfig.
class PythonConfig final : public shot::OcioConfig {
public:
    /// Requires the GIL.
    explicit PythonConfig(const std::string& name)
        : name_(name), config_(shared(py::module_::import("realcam.ocio").attr("opened")(text_from(name)))) {}

    std::shared_ptr<const View> view(const std::string& display, const std::string& view) const override {
        return call_python([&] {
            return std::make_shared<PythonView>(
                py::module_::import("realcam.ocio")
                    .attr("OcioView")(text_from(name_), text_from(display), text_from(view)));
        });
    }

    io::ColorConversion to_rec709(const std::string& color_space, const std::string& path) const override {
        return call_python([&] {
            const auto convert = shared(config_->attr("conversion_to_rec709")(text_from(color_space), text_from(path)));
            return [convert](std::span<float> rgb) {
                call_python([&] {
                    const std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(rgb.size() / 3), 3};
                    // With a base object the array refers to the colours instead of copying them.
                    (*convert)(py::array_t<float>(shape, rgb.data(), py::none()));
                });
            };
        });
    }

private:
    std::string name_;
    std::shared_ptr<py::object> config_;
};

}  // namespace

std::shared_ptr<const View> view_from(const py::object& tone) {
    if (py::isinstance<py::str>(tone)) return std::make_shared<ToneView>(tone_curve_from(tone.cast<std::string>()));
    if (!py::isinstance(tone, py::module_::import("realcam.ocio").attr("OcioView")))
        throw InputError("a tone must be the name of a tone curve or an OcioView");
    return std::make_shared<PythonView>(tone);
}

py::object tone_from(const View& view) {
    if (const auto* const ocio = dynamic_cast<const PythonView*>(&view)) return ocio->object();
    return py::str(view.entries().at(0).second);
}

void register_ocio() {
    shot::ocio_reader() = [](const std::string& config) {
        return call_python([&] { return std::make_shared<PythonConfig>(config); });
    };
}

}  // namespace realcam::bindings
