#include "denoiser.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>

#include "../error.hpp"
#include "../render/session/progress.hpp"
#include "oidn_library.hpp"

namespace realcam {
namespace {

constexpr std::size_t kPixelBytes = 3 * sizeof(float);  ///< size of a pixel in the library's images

/// Owning handle of an object of Open Image Denoise.
template <class Handle>
class Owned {
public:
    Owned(Handle handle, void (*release)(Handle)) : handle_(handle), release_(release) {}
    Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)), release_(other.release_) {}
    Owned& operator=(Owned&&) = delete;
    ~Owned() {
        if (handle_) release_(handle_);
    }
    operator Handle() const { return handle_; }

private:
    Handle handle_;
    void (*release_)(Handle);
};

/// Least width and height in pixels: the network reads a neighbourhood of this size, and changes the light of smaller
/// pictures.
constexpr int kMinSide = 16;

/// Crops a picture of three floats per pixel to a size, or extends it by repeating its edge pixels.
std::vector<float> resized(const float* values, int width, int height, int to_width, int to_height) {
    std::vector<float> result;
    result.reserve(3 * static_cast<std::size_t>(to_width) * static_cast<std::size_t>(to_height));
    for (int y = 0; y < to_height; ++y)
        for (int x = 0; x < to_width; ++x) {
            const auto pixel = static_cast<std::size_t>(std::min(y, height - 1)) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(std::min(x, width - 1));
            result.insert(result.end(), values + 3 * pixel, values + 3 * pixel + 3);
        }
    return result;
}

/// Returns the ordinal of the GPU that a device name stands for, or std::nullopt for the CPU.
std::optional<int> gpu_of(const oidn::Library& library, const std::string& device) {
    if (device == "cpu") return std::nullopt;
    int ordinal = 0;
    if (device.starts_with("cuda:")) std::from_chars(device.data() + 5, device.data() + device.size(), ordinal);
    if (library.is_cuda_device_supported(ordinal)) return ordinal;
    if (device == "auto") return std::nullopt;
    throw DeviceError("Open Image Denoise cannot use the GPU " + std::to_string(ordinal) + "; use device cpu");
}

}  // namespace

/// The library, its device, and the filters for the last picture size.
struct Denoiser::Parts {
    Parts(const std::string& device_name, int threads, const std::string& path)
        : library(oidn::library(path)),
          gpu(gpu_of(library, device_name)),
          device(new_device(), library.release_device) {
        if (!gpu) {
            library.set_device_int(device, "numThreads", threads);
            // The renderer uses the same threads, which must not be pinned to a core each.
            library.set_device_bool(device, "setAffinity", false);
        }
        library.commit_device(device);
        check();
    }

    /// Creates the device: the GPU or the CPU.
    oidn::Device new_device() const {
        const oidn::Stream default_stream = nullptr;
        const oidn::Device created =
            gpu ? library.new_cuda_device(&*gpu, &default_stream, 1) : library.new_device(oidn::kCpu);
        if (!created) check(nullptr);
        return created;
    }

    /// Throws Cancelled or DeviceError if the library has reported an error.
    void check() const { check(device); }
    /// check() for a device. Null: throws the error of creating one.
    void check(oidn::Device device_or_null) const {
        const char* message = nullptr;
        const int error = library.get_device_error(device_or_null, &message);
        if (error == oidn::kCancelled) throw Cancelled();
        if (error != 0 || !device_or_null)
            throw DeviceError(std::string("Open Image Denoise: ") + (message ? message : "no device"));
    }

    /// Filters and buffers for one picture size and quality. They are reused, because creating them takes as long as
    /// denoising a small picture.
    struct Filters {
        Filters(const Parts& parts, int width, int height, DenoiseQuality quality)
            : width(width),
              height(height),
              quality(quality),
              color(parts.buffer(bytes())),
              albedo(parts.buffer(bytes())),
              normal(parts.buffer(bytes())),
              output(parts.buffer(bytes())),
              picture(parts.filter()) {
            const bool is_high = quality == DenoiseQuality::high;
            if (is_high)
                for (const auto& [name, image] : {std::pair("albedo", &albedo), std::pair("normal", &normal)}) {
                    layers.push_back(parts.filter());
                    set(parts, layers.back(), name, *image);
                    set(parts, layers.back(), "output", *image);
                    // kHigh takes more than twice the time for the layers, and brings the denoised picture no closer to
                    // the converged one.
                    parts.library.set_filter_int(layers.back(), "quality", oidn::kBalanced);
                    parts.library.commit_filter(layers.back());
                }
            set(parts, picture, "color", color);
            set(parts, picture, "albedo", albedo);
            set(parts, picture, "normal", normal);
            set(parts, picture, "output", output);
            parts.library.set_filter_bool(picture, "hdr", true);
            parts.library.set_filter_bool(picture, "cleanAux", is_high);
            parts.library.set_filter_int(picture, "quality", is_high ? oidn::kHigh : oidn::kFast);
            parts.library.commit_filter(picture);
            parts.check();
        }

        std::size_t bytes() const {
            return kPixelBytes * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        }
        /// Sets a buffer as an image of a filter.
        void set(const Parts& parts, oidn::Filter filter, const char* name, oidn::Buffer buffer) const {
            parts.library.set_filter_image(filter, name, buffer, oidn::kFloat3, static_cast<std::size_t>(width),
                                           static_cast<std::size_t>(height), 0, 0, 0);
        }

        int width, height;
        DenoiseQuality quality;
        Owned<oidn::Buffer> color, albedo, normal, output;
        /// Filters that denoise albedo and normal in place; empty for DenoiseQuality::fast.
        std::vector<Owned<oidn::Filter>> layers;
        Owned<oidn::Filter> picture;
    };

    /// Creates a buffer.
    Owned<oidn::Buffer> buffer(std::size_t bytes) const {
        Owned<oidn::Buffer> created(library.new_buffer(device, bytes), library.release_buffer);
        check();
        return created;
    }
    /// Creates a filter for path-traced pictures ("RT").
    Owned<oidn::Filter> filter() const {
        Owned<oidn::Filter> created(library.new_filter(device, "RT"), library.release_filter);
        check();
        return created;
    }

    /// Returns the filters for a size and quality, and creates them if they differ from the last ones.
    const Filters& filters_for(int width, int height, DenoiseQuality quality) {
        if (!filters || filters->width != width || filters->height != height || filters->quality != quality) {
            filters.reset();  // frees their memory before the next are created
            filters = std::make_unique<Filters>(*this, width, height, quality);
        }
        return *filters;
    }

    /// Runs a filter. `can_stop`: true if it is stopped when `stop` becomes true.
    void execute(oidn::Filter filter, std::atomic<bool>& stop, bool can_stop) const {
        const auto continues = [](void* stopped, double) { return !*static_cast<std::atomic<bool>*>(stopped); };
        // A progress monitor costs time on a GPU.
        library.set_filter_monitor(filter, can_stop ? oidn::Monitor(continues) : nullptr, &stop);
        library.commit_filter(filter);
        library.execute_filter(filter);
        check();
    }

    const oidn::Library& library;
    std::optional<int> gpu;  ///< ordinal; std::nullopt: the CPU
    Owned<oidn::Device> device;
    std::unique_ptr<Filters> filters;
};

Denoiser::Denoiser(const std::string& device, int threads, const std::string& library)
    : parts_(std::make_unique<Parts>(device, threads, library)) {}

Denoiser::~Denoiser() = default;

std::string Denoiser::name() const {
    const int version = parts_->library.get_device_int(parts_->device, "version");
    return "Open Image Denoise " + std::to_string(version / 10000) + '.' + std::to_string(version / 100 % 100) + '.' +
           std::to_string(version % 100);
}

std::vector<float> Denoiser::denoised(const NoisyPicture& picture, DenoiseQuality quality,
                                      const KeepGoing& keep_going) {
    if (const int width = std::max(picture.width, kMinSide), height = std::max(picture.height, kMinSide);
        width != picture.width || height != picture.height) {
        const auto larger = [&](const float* values) {
            return resized(values, picture.width, picture.height, width, height);
        };
        const auto [exposure, albedo, normal] =
            std::tuple(larger(picture.exposure), larger(picture.albedo), larger(picture.normal));
        const std::vector<float> result =
            denoised({width, height, exposure.data(), albedo.data(), normal.data()}, quality, keep_going);
        return resized(result.data(), width, height, picture.width, picture.height);
    }
    const Parts::Filters& filters = parts_->filters_for(picture.width, picture.height, quality);
    const oidn::Library& library = parts_->library;
    std::vector<float> result(filters.bytes() / sizeof(float));
    std::atomic<bool> stop{false};
    const auto work = [&] {
        library.write_buffer(filters.color, 0, filters.bytes(), picture.exposure);
        library.write_buffer(filters.albedo, 0, filters.bytes(), picture.albedo);
        library.write_buffer(filters.normal, 0, filters.bytes(), picture.normal);
        const bool can_stop = static_cast<bool>(keep_going);
        for (const oidn::Filter layer : filters.layers) parts_->execute(layer, stop, can_stop);
        parts_->execute(filters.picture, stop, can_stop);
        library.read_buffer(filters.output, 0, filters.bytes(), result.data());
        parts_->check();
    };
    run_interruptibly(work, keep_going, stop);
    if (stop) throw Cancelled();
    for (float& value : result) value = std::max(value, 0.0f);
    return result;
}

void denoise(Image& image, LayerSet kept, Denoiser& denoiser, const KeepGoing& keep_going) {
    const auto values_of = [&](Layer layer) {
        const auto matches = [&](const LayerImage& other) { return other.layer == layer; };
        return std::find_if(image.layers.begin(), image.layers.end(), matches)->values.data();
    };
    // Light traced from lamps is not denoised: the noise of lamps out of focus is a fine grain in their discs, which
    // the network mistakes for detail and spreads.
    const float* traced = values_of(Layer::traced_light);
    std::vector<float> pixel_light(image.exposure.begin(), image.exposure.end());
    for (std::size_t i = 0; i < pixel_light.size(); ++i) pixel_light[i] = std::max(pixel_light[i] - traced[i], 0.0f);
    std::vector<float> denoised = denoiser.denoised(
        {image.width, image.height, pixel_light.data(), values_of(Layer::albedo), values_of(Layer::normal)},
        DenoiseQuality::high, keep_going);
    // The larger the fraction of traced light in a pixel, the less of its other light is replaced by the denoised one:
    // the noise is invisible beside the lamp, and part of that light is the lamp's own, found by pixel samples.
    for (std::size_t i = 0; i < pixel_light.size(); ++i) {
        const float all = traced[i] + denoised[i], share = all > 0 ? traced[i] / all : 0;
        denoised[i] += share * (pixel_light[i] - denoised[i]) + traced[i];
    }
    image.exposure = PictureFloats(std::move(denoised));
    keep_layers(image, kept);
    // These layers describe the noise or contain it.
    constexpr LayerSet kNoisy = {Layer::variance, Layer::dual_pixel_left, Layer::dual_pixel_right};
    std::erase_if(image.layers, [&](const LayerImage& layer) { return kNoisy.has(layer.layer); });
}

}  // namespace realcam
