#pragma once
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "../render/gradients/film_radiance.hpp"
#include "embree_scene.hpp"
#include "kernels.hpp"
#include "picture_gradient.hpp"

// Blocks of samples of one row of the film of a PictureGradient, and the rays whose tangents are traced.

namespace realcam {

/// Light of a sample on the film, or on the outline of the pupil.
struct PictureGradient::SampleLight {
    Vec2f pixel;  ///< film point, in pixels of the picture
    Color light;  ///< weight times radiance
    float weight;
    float variable;  ///< WavelengthVariable of the sample, if the camera has dispersion
};

/// Rays that wait until a block of them can be traced with their M tangents.
template <int M>
struct PictureGradient::RayBlock {
    TangentRays<kRays, M> rays;
    SampleLight lights[kRays];
    float variable[kRays];
    int count = 0;

    /// Adds a ray at the film, whose tangents are not set.
    void add(const SampleLight& light, const OutlineLens& lens, Vec3f origin, Vec3f direction) {
        set_film_ray(lens, origin, direction, rays, count);
        variable[count] = light.variable;
        lights[count++] = light;
    }
    /// Fills the other lanes with copies of the last ray, whose tangents are 0.
    void complete() {
        for (int i = 0; i < kRays; ++i) rays.status[i] = 0;
        for (int i = count; i < kRays; ++i) {
            rays.origin.set(i, rays.origin[count - 1]);
            rays.direction.set(i, rays.direction[count - 1]);
            for (RayTangents<kRays>& tangents : rays.tangents) tangents.direction.set(i, {0, 0, 0});
            variable[i] = variable[count - 1];
        }
    }
};

/// Rays that graze a rim, with the light that they bring.
struct PictureGradient::OutlineBlock {
    LensRays<double, kRays> rays;
    const OutlinePoint* points[kRays];
    SampleLight lights[kRays];
    int count;  ///< lanes in use; the others hold copies of the last ray
};

/// The scene, and the device of Embree that holds it.
struct PictureGradient::EmbreeParts {
    struct ReleaseDevice {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    };

    std::unique_ptr<RTCDeviceTy, ReleaseDevice> device{new_embree_device()};
    std::atomic<bool> stop{false};  ///< never set: the construction is not interrupted
    EmbreeScene scene;

    EmbreeParts(const Assembly& of, const Camera& camera)
        : scene(device.get(), of, position_when_open(camera), camera.exposure(), stop) {}
};

/// Samples of one row of the extended film, with working memory.
class PictureGradient::Row {
public:
    Row(const PictureGradient& of, const GradientSamples& samples, int row)
        : of_(of),
          samples_(samples),
          row_(row),
          scene_view_(of.embree_->scene.placed().view()),
          path_settings_(of.settings_.path()) {}

    /// Calls f(lane, light of its sample, samples) for blocks of samples on the film, for the lanes whose rays pass.
    template <class F>
    void for_film_samples(F&& f) {
        SampleBlock<kLanes> block;
        FilmSamples<kLanes> film;
        PathResults<kLanes> results;
        for_blocks(samples_.spp, samples_.seed, block, [&](int) {
            for (int i = 0; i < kLanes; ++i) film.mirrored[i] = samples_.pairs ? pair_sample(block, i) : 0;
            realcam_gradient_block request = request_for(block);
            request.film = &film;
            kernels().sample_film(&request);
            trace(block, film.rays, film.time, results);
            for (int i = 0; i < kLanes; ++i)
                if (film.rays.passed[i])
                    f(i,
                      SampleLight{of_.film_.in_picture(film.pixel[i]),
                                  on_film(results.irradiance[i], film.wavelengths.cell_position[i]),
                                  film.rays.weight[i], film.variable[i]},
                      film);
        });
    }

    /// Calls f(OutlineBlock&) for blocks of samples on the outline of the pupil.
    template <class F>
    void for_outline_samples(F&& f) {
        SampleBlock<kLanes> block;
        for_blocks(samples_.outline_spp, samples_.outline_seed(), block, [&](int used) {
            const PixelPoints<kLanes> film(of_.view_, block);
            const LaneNumbers<kLanes> u(block, dimension::pupil);
            FilmSamples<kLanes> samples;
            if (of_.view_.effects.dispersion) sample_wavelengths(of_.view_, block, samples);
            std::vector<Edge> edges;
            for (int first = 0; first < used; first += kRays) find_edges(block, film, u, samples, first, used, edges);
            for (std::size_t first = 0; first < edges.size(); first += kLanes)
                shade_edges(block, edges, first, std::min<std::size_t>(kLanes, edges.size() - first), f);
        });
    }

    std::int64_t unexplained = 0, edge_count = 0;

private:
    /// Edge of the pupil at a film point.
    struct Edge {
        int lane;  ///< lane of its sample
        Vec2f pixel;  ///< film point, in pixels of the picture
        double weight;  ///< inverse density
        float variable, cell_position;  ///< of the sample's wavelength, if the camera has dispersion
        DirectionLine line;
        OutlinePoint point;
    };

    /// Colour on the film of the irradiance of a sample with a wavelength; without dispersion, the irradiance itself.
    Color on_film(Color irradiance, float cell_position) const {
        if (!of_.view_.effects.dispersion || samples_.uniform) return irradiance;
        return film_color(of_.view_.dispersion, cell_position, irradiance);
    }

    /// Calls f(number of lanes in use) for blocks of samples of the row's pixels.
    template <class F>
    void for_blocks(int spp, std::uint32_t seed, SampleBlock<kLanes>& block, F&& f) {
        const std::int64_t count = std::int64_t{of_.view_.width} * spp;
        for (std::int64_t first = 0; first < count; first += kLanes) {
            const int used = static_cast<int>(std::min<std::int64_t>(kLanes, count - first));
            for (int i = 0; i < kLanes; ++i) {
                of_.film_.set_sample(block, i, row_, first + (i < used ? i : 0), spp, seed);
                block.used[i] = i < used;
            }
            f(used);
        }
    }

    /// Traces paths, or sets the irradiance of uniform light.
    void trace(const SampleBlock<kLanes>& block, const CameraRays<kLanes>& rays, const Lanes<float, kLanes>& time,
               PathResults<kLanes>& results) {
        if (samples_.uniform) {
            for (int i = 0; i < kLanes; ++i) results.irradiance.set(i, grey(rays.passed[i] ? rays.weight[i] : 0.0f));
            return;
        }
        realcam_gradient_block request = request_for(block);
        request.rays = &rays, request.time = &time, request.results = &results;
        kernels().trace_radiance(&request);
    }
    realcam_gradient_block request_for(const SampleBlock<kLanes>& block) const {
        return {&scene_view_, &of_.view_, of_.embree_->scene.handle(), &path_settings_, &block, nullptr, nullptr,
                nullptr,      nullptr};
    }

    /// Sends lines from the centres of the pupil's boxes in random directions.
    void find_edges(const SampleBlock<kLanes>& block, const PixelPoints<kLanes>& film, const LaneNumbers<kLanes>& u,
                    const FilmSamples<kLanes>& samples, int first, int used, std::vector<Edge>& edges) {
        PupilLine from_centre[kRays];
        DirectionLine lines[kRays];
        float variable[kRays];
        for (int i = 0; i < kRays; ++i) {
            const int lane = std::min(first + i, used - 1);
            from_centre[i] = pupil_line(of_.view_, film[lane], u[lane].x);
            lines[i] = from_centre[i].line;
            variable[i] = samples.variable[lane];
        }
        OutlinePoint points[OutlineRays::kMostPoints][kRays];
        const WavelengthsInDouble wavelengths = of_.wavelengths(variable);
        unexplained += of_.outline_.find(of_.path_, lines, PupilLine::kEnd, of_.if_dispersed(wavelengths), points);
        for (const auto& lanes : points)
            for (int i = 0; i < kRays && first + i < used; ++i) {
                const OutlinePoint& point = lanes[i];
                if (!(point.t > 0)) continue;
                const int lane = first + i;
                const Vec2f offset = film.u[lane];
                const Vec2f pixel = {static_cast<float>(block.column[lane]) + offset.x,
                                     static_cast<float>(block.row[lane]) + offset.y};
                edges.push_back({lane, of_.film_.in_picture(pixel), from_centre[i].weight(point), variable[i],
                                 samples.wavelengths.cell_position[lane], lines[i], point});
            }
        edge_count += std::min(used - first, kRays);
    }

    /// Traces the paths of `count` edges, and calls f for blocks of kRays.
    template <class F>
    void shade_edges(const SampleBlock<kLanes>& film_block, const std::vector<Edge>& edges, std::size_t first,
                     std::size_t count, F&& f) {
        SampleBlock<kLanes> block;
        CameraRays<kLanes> rays;
        PathResults<kLanes> results;
        Lanes<float, kLanes> time;
        for (std::size_t i = 0; i < kLanes; ++i) {
            const Edge& edge = edges[first + std::min(i, count - 1)];
            const int lane = edge.lane, at = static_cast<int>(i);
            block.column[at] = film_block.column[lane], block.row[at] = film_block.row[lane];
            block.stream[at] = film_block.stream[lane], block.sample[at] = film_block.sample[lane];
            block.used[at] = i < count;
            set_outline_ray(of_.view_, edge.point, i < count, rays, at);
        }
        expose_rays(of_.view_, block, rays, time);
        trace(block, rays, time, results);
        for (std::size_t begin = 0; begin < count; begin += kRays) {
            DirectionLine lines[kRays];
            double t[kRays];
            OutlineBlock outline;
            outline.count = static_cast<int>(std::min<std::size_t>(kRays, count - begin));
            for (int i = 0; i < kRays; ++i) {
                const int lane = static_cast<int>(begin) + std::min(i, outline.count - 1);
                const Edge& edge = edges[first + static_cast<std::size_t>(lane)];
                lines[i] = edge.line, t[i] = edge.point.t, outline.points[i] = &edge.point;
                const auto weight = static_cast<float>(edge.weight);
                outline.lights[i] = {edge.pixel, weight * on_film(results.irradiance[lane], edge.cell_position), weight,
                                     edge.variable};
            }
            outline.rays = of_.outline_.start(lines, t);
            f(outline);
        }
    }

    const PictureGradient& of_;
    const GradientSamples& samples_;
    int row_;
    SceneView scene_view_;
    PathSettings path_settings_;
};

}  // namespace realcam
