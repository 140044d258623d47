#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "../platform.hpp"
#include "layers.hpp"
#include "picture_floats.hpp"

namespace REALCAM_NAMESPACE {

/// What a picture cost. Seconds of the stages are summed over the threads.
struct RenderStats {
    double seconds = 0;        ///< wall clock, all of it
    double setup_seconds = 0;  ///< pupil and scene, part of the above
    double lens_seconds = 0, scene_seconds = 0, other_seconds = 0;
    std::uint64_t sampled_rays = 0;  ///< sent into the lens
    std::uint64_t passed_rays = 0;   ///< that left it
    std::uint64_t scene_rays = 0;    ///< camera, shadow and bounce rays traced in the scene
    std::string device;
};

/// A noiseless exposure, as it lies on the film.
struct Image {
    int width = 0, height = 0;
    PictureFloats exposure;  ///< height * width * 3, lux seconds, linear Rec. 709
    PictureFloats depth;  ///< height * width, metres along the axis from the film; below 0 behind it, which a
                          ///< fisheye may see; infinite: nothing there
    std::vector<LayerImage> layers;  ///< those that were asked for, but for depth
    IdNames object_names, material_names;  ///< of the ids in layers; empty where there are none
    std::int64_t spp = 0;  ///< samples that were asked for, per pixel; where noise was, their mean
    std::string shortfall;  ///< of the noise from its goal, a sentence; empty: there is none
    RenderStats stats;
};

/// Drops the layers that are not among these.
inline void keep_layers(Image& image, LayerSet wanted) {
    std::erase_if(image.layers, [&](const LayerImage& layer) { return !wanted.has(layer.layer); });
}

}  // namespace REALCAM_NAMESPACE
