#pragma once
#include <memory>
#include <string>
#include <vector>

#include "../checkpoint.hpp"
#include "../render/film/image.hpp"

namespace realcam {

/// Method of denoising.
enum class DenoiseQuality {
    high,  ///< denoises albedo and normals first, then the picture with their help
    fast,  ///< denoises the picture with noisy albedo and normals; for previews
};

/// Input of Open Image Denoise: three floats per pixel in each array, row by row.
struct NoisyPicture {
    int width, height;
    const float* exposure;  ///< linear RGB of any scale, not negative
    const float* albedo;    ///< RGB, 0 to 1
    const float* normal;    ///< x, y, z in any frame, -1 to 1
};

/// Denoiser that uses Intel's Open Image Denoise. Two threads must not use it at once.
class Denoiser {
public:
    /// `library`: see oidn::library. `device`: a name as for make_session; of several GPUs the first is used, and
    /// "auto" is the CPU if the library supports no GPU. `threads`: number of CPU threads; 0: all. Throws InputError if
    /// the library is missing, and DeviceError if it cannot use the device.
    explicit Denoiser(const std::string& device = "auto", int threads = 0, const std::string& library = "");
    ~Denoiser();
    Denoiser(const Denoiser&) = delete;
    Denoiser& operator=(const Denoiser&) = delete;

    /// Returns the library's name and version, for display and for the metadata of pictures.
    std::string name() const;

    /// Returns the denoised exposure, three floats per pixel. Throws DeviceError if the library fails, and Cancelled if
    /// `keep_going` returns false.
    std::vector<float> denoised(const NoisyPicture& picture, DenoiseQuality quality, const KeepGoing& keep_going = {});

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Denoises the exposure of a picture that has all kDenoiserLayers, except for the light that was traced from lamps.
/// Removes the layers that are not in `kept`, and those that describe or contain the noise (variance, dual pixels).
/// Throws as Denoiser.
void denoise(Image& image, LayerSet kept, Denoiser& denoiser, const KeepGoing& keep_going);

}  // namespace realcam
