#pragma once
#include <string>

#include "../../io/files/image_metadata.hpp"
#include "../../render/film/image.hpp"
#include "../typed_object.hpp"

namespace realcam::bindings {

/// A realcam.Image (python/realcam/image.py).
using PythonImage = Typed<"Image">;

/// Returns a picture as a realcam.Image, whose arrays use the memory of `image`. `plan`: summary of the plan, or empty.
PythonImage python_image(Image image, const Camera& camera, const RenderSettings& settings,
                         const std::string& plan = {});

/// Returns an attribute of a realcam.Image. Throws InputError if it has another type.
template <class T>
T attribute_of(const PythonImage& image, const char* name) {
    try {
        return image.attr(name).template cast<T>();
    } catch (const pybind11::cast_error&) {
        throw InputError("the image's " + std::string(name) + " must have the type that rc.render returns");
    }
}

/// Returns the metadata of a realcam.Image for picture files. Throws InputError if an attribute has the wrong type.
io::ImageMetadata metadata_of(const PythonImage& image);

}  // namespace realcam::bindings
