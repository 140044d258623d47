#pragma once
#include <memory>
#include <string>
#include <vector>

#include "../keep_going.hpp"
#include "../render/image.hpp"

namespace realcam {

enum class DenoiseQuality {
    high,  ///< first the layers are denoised, then the picture by them
    fast,  ///< the picture by the layers as they are: for previews
};

/// What Open Image Denoise reads: three floats per pixel each, row by row.
struct NoisyPicture {
    int width, height;
    const float* exposure;  ///< linear, not negative
    const float* albedo;    ///< 0 to 1
    const float* normal;    ///< -1 to 1
};

/// Intel's Open Image Denoise, which guesses the picture without noise. Not for two threads at once.
class Denoiser {
public:
    /// `library`: see oidn::library. `device`: as make_session has it; of several GPUs the first is taken, and the CPU
    /// where "auto" finds none that the library can use. `threads`: of the CPU; 0: all. Throws InputError where the
    /// library is missing, and DeviceError where the device is no use to it.
    explicit Denoiser(const std::string& device = "auto", int threads = 0, const std::string& library = "");
    ~Denoiser();
    Denoiser(const Denoiser&) = delete;
    Denoiser& operator=(const Denoiser&) = delete;

    /// Its name and version, for people and for the metadata of pictures.
    std::string name() const;

    /// The exposure without noise. Throws DeviceError, and Cancelled.
    std::vector<float> denoised(const NoisyPicture& picture, DenoiseQuality quality, const KeepGoing& keep_going = {});

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Takes the noise from the exposure of a picture, by its kDenoiserLayers, which it must have, but for that of the
/// light that was traced from lights. Layers that are not `wanted` go, and so does the variance, which would be that of
/// the noise. Throws as Denoiser.
void denoise(Image& image, LayerSet wanted, Denoiser& denoiser, const KeepGoing& keep_going);

}  // namespace realcam
