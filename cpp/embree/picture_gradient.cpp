#include "picture_gradient.hpp"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "../render/gradients/film_radiance.hpp"
#include "../render/gradients/filtered_film.hpp"
#include "../scene/scene_checks.hpp"
#include "embree_scene.hpp"
#include "lens_rays.hpp"
#include "packet_scene.hpp"

namespace realcam {

namespace {

constexpr int kLanes = 256;  ///< film samples per block
constexpr int kRays = TangentPath::kLanes;  ///< rays with tangents per block

/// Throws InputError for a feature of the camera or the settings that derivatives do not support.
void check_supported(const Camera& camera, const RenderSettings& settings, PixelFilter filter) {
    const auto refuse = [](const std::string& what) { throw InputError("derivatives of pictures " + what); };
    if (filter == PixelFilter::box)
        refuse("need a smooth pixel filter, tent or gaussian; that of the box is a delta function at its edges");
    if (camera.model != CameraModel::full_lens) refuse("need the camera model full");
    if (camera.geometry) refuse("do not support calibrated cameras");
    if (camera.moves()) refuse("do not support cameras that move during the exposure");
    for (const EffectInfo& effect : kEffects)
        if (settings.effects.*effect.member && !effect.is_on() && effect.member != &EffectChoice::dispersion)
            refuse(std::string("do not support the effect ") + effect.name);
    if (settings.pupil_sampling != PupilSampling::outline) refuse("need the pupil sampling outline");
}

/// Flattens derivatives in the order of PictureGradient.
void append_numbers(const CameraDerivatives& from, double by_stop, std::vector<double>& to) {
    to.insert(to.end(), from.by_variable.begin(), from.by_variable.end());
    to.insert(to.end(), from.by_film.begin(), from.by_film.end());
    to.insert(to.end(), from.by_pose.begin(), from.by_pose.end());
    to.push_back(by_stop);
}

/// Light of a sample on the film, or on the outline of the pupil.
struct SampleLight {
    Vec2f pixel;  ///< film point, in pixels of the picture
    Color light;  ///< weight times radiance
    float weight;
    float variable;  ///< WavelengthVariable of the sample, if the camera has dispersion
};

}  // namespace

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

Camera PictureGradient::extended(Camera camera, int margin) {
    Film& film = camera.film;
    film.width_mm *= static_cast<double>(film.width + 2 * margin) / film.width;
    film.height_mm *= static_cast<double>(film.height + 2 * margin) / film.height;
    film.width += 2 * margin;
    film.height += 2 * margin;
    return camera;
}

PictureGradient::PictureGradient(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                                 PixelFilter filter, std::vector<LensVariable> variables)
    : camera_((validate(camera), check_supported(camera, settings, filter), camera)),
      settings_(settings),
      filter_(filter),
      margin_(static_cast<int>(std::ceil(filter_radius(filter) - 0.5f))),
      path_(camera.lens, camera.lens.wavelength_nm, std::move(variables)),
      outline_(camera.lens, camera.lens.wavelength_nm),
      setup_(std::make_shared<const CameraSetup>(extended(camera, margin_), fast_pupil_tracer(), nullptr,
                                                 settings.lens_effects())),
      film_index_(camera.lens.indices(camera.lens.wavelength_nm).back()) {
    SceneChecks().check(scene);
    if (scene.moves() && camera.shutter.readout_time_s > 0)
        throw InputError("derivatives of pictures do not support rolling shutters in scenes that move");
    embree_ = std::make_unique<const EmbreeParts>(scene, camera);
    view_ = setup_->view(embree_->scene.placed().origin_m(), embree_->scene.placed().moves());
}

PictureGradient::~PictureGradient() = default;

/// Samples of one row of the extended film, with working memory.
class PictureGradient::Row {
public:
    Row(const PictureGradient& of, const GradientSamples& samples, int row)
        : of_(of),
          samples_(samples),
          row_(row),
          scene_view_(of.embree_->scene.placed().view()),
          scene_{of.embree_->scene.handle(), static_cast<std::uint32_t>(scene_view_.instance_count), RayOrder::coherent,
                 0} {}

    /// Calls f(lane, light of its sample, samples) for blocks of samples on the film, for the lanes whose rays pass.
    template <class F>
    void for_film_samples(F&& f) {
        SampleBlock<kLanes> block;
        FilmSamples<kLanes> film;
        PathResults<kLanes> results;
        for_blocks(samples_.spp, samples_.seed, block, [&](int) {
            if (needs_general_lens_code(of_.view_))
                sample_film<LensKind::any>(of_.view_, block, film);
            else
                sample_film<LensKind::rotational>(of_.view_, block, film);
            trace(block, film.rays, film.time, results);
            for (int i = 0; i < kLanes; ++i)
                if (film.rays.passed[i])
                    f(i,
                      SampleLight{in_picture(film.pixel[i]),
                                  on_film(results.irradiance[i], film.wavelengths.cell_position[i]),
                                  film.rays.weight[i], film.variable[i]},
                      film);
        });
    }

    /// Calls f(start rays, outline points, lights, count) for blocks of samples on the outline of the pupil.
    template <class F>
    void for_outline_samples(F&& f) {
        SampleBlock<kLanes> block;
        constexpr std::uint32_t kSalt = 0x6f75746cu;  // samples of the outline are independent of those of the film
        for_blocks(samples_.outline_spp, hash32(samples_.seed, kSalt), block, [&](int used) {
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

    Vec2f in_picture(Vec2f pixel) const {
        const auto margin = static_cast<float>(of_.margin_);
        return {pixel.x - margin, pixel.y - margin};
    }

    /// Colour on the film of the irradiance of a sample with a wavelength; without dispersion, the irradiance itself.
    Color on_film(Color irradiance, float cell_position) const {
        if (!of_.view_.effects.dispersion || samples_.uniform) return irradiance;
        return film_color(of_.view_.dispersion, cell_position, irradiance);
    }

    /// Calls f(number of lanes in use) for blocks of samples of the row's pixels.
    template <class F>
    void for_blocks(int spp, std::uint32_t seed, SampleBlock<kLanes>& block, F&& f) {
        const int width = of_.camera_.film.width, height = of_.camera_.film.height;
        const std::int64_t count = std::int64_t{of_.view_.width} * spp;
        for (std::int64_t first = 0; first < count; first += kLanes) {
            const int used = static_cast<int>(std::min<std::int64_t>(kLanes, count - first));
            for (int i = 0; i < kLanes; ++i) {
                const std::int64_t sample = first + (i < used ? i : 0);
                const int column = static_cast<int>(sample / spp), x = column - of_.margin_, y = row_ - of_.margin_;
                const bool inside = x >= 0 && x < width && y >= 0 && y < height;
                // Pixels of the picture have its random numbers; those beyond its border have others.
                const int index = inside ? y * width + x : width * height + row_ * of_.view_.width + column;
                block.column[i] = column;
                block.row[i] = row_;
                block.used[i] = i < used;
                block.stream[i] = pixel_stream(index, seed);
                block.sample[i] = static_cast<std::uint32_t>(sample % spp);
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
        scene_.order = RayOrder::coherent;
        trace_radiance(scene_view_, of_.view_, of_.settings_.path(), block, rays, time, scene_, results);
    }

    /// Sends lines from the centres of the pupil's boxes in random directions.
    void find_edges(const SampleBlock<kLanes>& block, const PixelPoints<kLanes>& film, const LaneNumbers<kLanes>& u,
                    const FilmSamples<kLanes>& samples, int first, int used, std::vector<Edge>& edges) {
        constexpr double kEnd = 1.6;  // in half-widths of the box, beyond its corners
        DirectionLine lines[kRays];
        double areas[kRays];
        float variable[kRays];
        for (int i = 0; i < kRays; ++i) {
            const int lane = std::min(first + i, used - 1);
            variable[i] = samples.variable[lane];
            lines[i] = line_of(film[lane], u[lane].x, areas[i]);
        }
        OutlinePoint points[OutlineRays::kMostPoints][kRays];
        const WavelengthsInDouble wavelengths = of_.wavelengths(variable);
        unexplained += of_.outline_.find(of_.path_, lines, kEnd, of_.if_dispersed(wavelengths), points);
        for (const auto& lanes : points)
            for (int i = 0; i < kRays && first + i < used; ++i) {
                const OutlinePoint& point = lanes[i];
                if (!(point.t > 0)) continue;
                const int lane = first + i;
                const Vec2f offset = film.u[lane];
                const Vec2f pixel = {static_cast<float>(block.column[lane]) + offset.x,
                                     static_cast<float>(block.row[lane]) + offset.y};
                edges.push_back({lane, in_picture(pixel),
                                 2 * std::numbers::pi * areas[i] * point.t * point.inverse_speed, variable[i],
                                 samples.wavelengths.cell_position[lane], lines[i], point});
            }
        edge_count += std::min(used - first, kRays);
    }

    /// Returns the line from the centre of the pupil's box at a film point, and the area of the box's quarter.
    DirectionLine line_of(Vec2f film, float u, double& area) const {
        const CameraView& view = of_.view_;
        return view.pupil_grid.nodes ? line_in(PupilLookup(view.pupil_grid, film.x, film.y), film, u, area)
                                     : line_in(PupilLookup(view.pupil, film.x, film.y), film, u, area);
    }
    template <class Map>
    static DirectionLine line_in(const PupilLookup<Map>& pupil, Vec2f film, float u, double& area) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(u);
        const Vec2f centre = pupil.to_film(pupil.from_box({0, 0}));
        const Vec2f step = pupil.to_film({pupil.box.half_width * static_cast<float>(std::cos(angle)),
                                          pupil.box.half_height * static_cast<float>(std::sin(angle))});
        area = static_cast<double>(pupil.box.half_width) * static_cast<double>(pupil.box.half_height);
        const auto vector = [](Vec2f v) { return Vec2d{static_cast<double>(v.x), static_cast<double>(v.y)}; };
        const bool lit = pupil.may_be_lit();
        return {vector(film), vector(centre), lit ? vector(step) : Vec2d{0, 0}};
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
            const Vec3d o = edge.point.origin;
            const Vec3d from_vertex = {o.x, o.y, o.z + 1000 * static_cast<double>(of_.view_.front_vertex_m)};
            set_camera_ray(
                of_.view_, rays, at,
                {static_cast<Vec3f>(from_vertex), static_cast<Vec3f>(normalized(edge.point.direction)), 1.0f},
                i < count);
            rays.sampled[at] = rays.passed[at] = i < count;
        }
        expose_rays(of_.view_, block, rays, time);
        trace(block, rays, time, results);
        for (std::size_t begin = 0; begin < count; begin += kRays) {
            DirectionLine lines[kRays];
            double t[kRays];
            const OutlinePoint* points[kRays];
            SampleLight lights[kRays];
            const int used = static_cast<int>(std::min<std::size_t>(kRays, count - begin));
            for (int i = 0; i < kRays; ++i) {
                const int lane = static_cast<int>(begin) + std::min(i, used - 1);
                const Edge& edge = edges[first + static_cast<std::size_t>(lane)];
                lines[i] = edge.line, t[i] = edge.point.t, points[i] = &edge.point;
                const auto weight = static_cast<float>(edge.weight);
                lights[i] = {edge.pixel, weight * on_film(results.irradiance[lane], edge.cell_position), weight,
                             edge.variable};
            }
            TangentPath::Rays starts = of_.outline_.start(lines, t);
            f(starts, points, lights, used);
        }
    }

    const PictureGradient& of_;
    const GradientSamples& samples_;
    int row_;
    SceneView scene_view_;
    PacketScene<SceneKind::any> scene_;
};

/// Sums of pictures over samples of the rows of the extended film. Each row has sums of its own for the few rows of
/// pixels that its samples count for; they are added in order, so that the result does not depend on the threads.
class PictureGradient::FilmRows {
public:
    FilmRows(const PictureGradient& of, std::size_t pictures)
        : of_(of), pictures_(pictures), rows_(static_cast<std::size_t>(of.view_.height)) {}

    std::vector<double>& rows_of(int row) {
        auto& sums = rows_[static_cast<std::size_t>(row)];
        sums.assign(pictures_ * kRowCount * row_size(), 0.0);
        return sums;
    }
    /// Adds a factor times light to a pixel. `rows`: those of a row of samples.
    void add(std::vector<double>& rows, int row, std::size_t picture, int pixel, double factor, Color light) const {
        const int width = of_.width(), offset = pixel / width - first_row(row);
        double* sum = rows.data() + (picture * kRowCount + static_cast<std::size_t>(offset)) * row_size() +
                      3 * static_cast<std::size_t>(pixel % width);
        sum[0] += factor * static_cast<double>(light.r);
        sum[1] += factor * static_cast<double>(light.g);
        sum[2] += factor * static_cast<double>(light.b);
    }
    /// Returns the pictures.
    std::vector<float> sum() const {
        const auto height = static_cast<std::size_t>(of_.height());
        std::vector<double> pictures(pictures_ * height * row_size());
        for (std::size_t row = 0; row < rows_.size(); ++row)
            for (std::size_t picture = 0; picture < pictures_; ++picture)
                for (std::size_t i = 0; i < kRowCount; ++i) {
                    const int to = first_row(static_cast<int>(row)) + static_cast<int>(i);
                    if (to < 0 || to >= of_.height()) continue;
                    const double* from = rows_[row].data() + (picture * kRowCount + i) * row_size();
                    double* sum = pictures.data() + (picture * height + static_cast<std::size_t>(to)) * row_size();
                    for (std::size_t k = 0; k < row_size(); ++k) sum[k] += from[k];
                }
        return {pictures.begin(), pictures.end()};
    }

private:
    /// Number of rows of pixels that the samples of a row count for: those within two pixels.
    static constexpr std::size_t kRowCount = 5;
    int first_row(int row) const { return row - of_.margin_ - 2; }
    std::size_t row_size() const { return 3 * static_cast<std::size_t>(of_.width()); }

    const PictureGradient& of_;
    std::size_t pictures_;
    std::vector<std::vector<double>> rows_;
};

template <class Pass>
void PictureGradient::run(const Pass& pass, const KeepGoing& keep_going) {
    const RayLoop loop = parallel_ray_loop({}, 1);
    // For more threads than cores, TBB writes a warning to the console and starts only as many as there are cores.
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(settings_.threads > 0 ? std::min(settings_.threads, cores) : cores);
    constexpr int kRowsBetweenCalls = 16;
    for (int first = 0; first < view_.height; first += kRowsBetweenCalls) {
        if (keep_going && !keep_going()) throw Cancelled();
        const int last = std::min(view_.height, first + kRowsBetweenCalls);
        arena.execute([&] {
            loop.for_all(static_cast<std::size_t>(last - first), [&](std::size_t begin, std::size_t end) {
                for (std::size_t row = begin; row < end; ++row) pass(first + static_cast<int>(row));
            });
        });
    }
}

double PictureGradient::exposure_per_sample(int spp) const {
    return camera_.exposure_time_s * settings_.filter_transmittance() / spp;
}

WavelengthsInDouble PictureGradient::wavelengths(const float* variable) const {
    return {view_.dispersion.to_scene, variable};
}

const WavelengthsInDouble* PictureGradient::if_dispersed(const WavelengthsInDouble& many) const {
    return view_.effects.dispersion ? &many : nullptr;
}

Vec3d PictureGradient::film_origin(Vec3f origin) const {
    return {static_cast<double>(origin.x), static_cast<double>(origin.y), camera_.lens.film_distance};
}

Vec3d PictureGradient::film_direction(Vec3f direction) const {
    const double l = static_cast<double>(direction.x), m = static_cast<double>(direction.y);
    return {l, m, -std::sqrt(film_index_ * film_index_ - l * l - m * m)};
}

Vec2d PictureGradient::pixels_per_mm() const {
    return {-camera_.film.width / camera_.film.width_mm, camera_.film.height / camera_.film.height_mm};
}

namespace {

/// Rays that wait until a block of them can be traced with their tangents.
struct RayBlock {
    TangentPath::Rays rays;
    SampleLight lights[kRays];
    float variable[kRays];
    int count = 0;

    /// Adds a ray at the film. Lanes that are not filled hold copies of the last ray, whose tangents are 0.
    void add(const SampleLight& light, Vec3d origin, Vec3d direction) {
        for (int i = count; i < kRays; ++i) {
            rays.origin.set(i, origin);
            rays.direction.set(i, direction);
            rays.direction_tangent.set(i, {0, 0, 0});
            rays.status[i] = 0;
            variable[i] = light.variable;
        }
        lights[count++] = light;
    }
    /// Sets the tangent of a ray by the light's direction cosines at the film, which are opposite to the ray's.
    void set_tangent(int lane, Vec2d w) {
        const Vec3d p = rays.direction[lane];
        rays.direction_tangent.set(lane, {-w.x, -w.y, (p.x * w.x + p.y * w.y) / p.z});
    }
};

}  // namespace

std::vector<float> PictureGradient::picture(const GradientSamples& samples, const KeepGoing& keep_going) {
    FilmRows film(*this, 1);
    const double scale = exposure_per_sample(samples.spp);
    run(
        [&](int row_index) {
            Row row(*this, samples, row_index);
            auto& rows = film.rows_of(row_index);
            row.for_film_samples([&](int, const SampleLight& sample, const FilmSamples<kLanes>&) {
                for_filtered_pixels(filter_, width(), height(), sample.pixel, [&](int pixel, float value, Vec2f) {
                    film.add(rows, row_index, 0, pixel, scale * static_cast<double>(value), sample.light);
                });
            });
        },
        keep_going);
    return film.sum();
}

std::vector<double> PictureGradient::reverse(const float* adjoint, const float* control, const GradientSamples& samples,
                                             const KeepGoing& keep_going) {
    std::vector<float> of_control;
    const auto pixels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    if (control)
        for (std::size_t i = 0; i < 3 * pixels; i += 3)
            of_control.push_back(adjoint[i] * control[i] + adjoint[i + 1] * control[i + 1] +
                                 adjoint[i + 2] * control[i + 2]);
    const AdjointFilm film{filter_, width(), height(), adjoint, control ? of_control.data() : nullptr};
    // Sums of the rows, which are added in order, make the result independent of the number of threads.
    std::vector<std::vector<double>> rows(static_cast<std::size_t>(view_.height));
    std::vector<std::int64_t> unexplained(rows.size()), edges(rows.size());
    const Vec2d per_mm = pixels_per_mm();
    run(
        [&](int row_index) {
            const auto at = static_cast<std::size_t>(row_index);
            Row row(*this, samples, row_index);
            TangentPath::Sums sums(path_);
            RayBlock block;
            const auto trace_block = [&] {
                const WavelengthsInDouble many = wavelengths(block.variable);
                path_.trace(block.rays, sums, nullptr, nullptr, if_dispersed(many));
                block.count = 0;
            };
            const double scale = exposure_per_sample(samples.spp);
            if (samples.interior)
                row.for_film_samples([&](int lane, const SampleLight& sample, const FilmSamples<kLanes>& from) {
                    const Vec3f slopes = film(sample.pixel, sample.light, sample.weight);
                    if (slopes.y == 0 && slopes.z == 0) return;
                    block.add(sample, film_origin(from.origin[lane]), film_direction(from.direction[lane]));
                    block.set_tangent(block.count - 1, {scale * per_mm.x * static_cast<double>(slopes.y),
                                                        scale * per_mm.y * static_cast<double>(slopes.z)});
                    if (block.count == kRays) trace_block();
                });
            if (block.count > 0) trace_block();
            double by_stop = 0;
            const double outline_scale = exposure_per_sample(samples.outline_spp);
            if (samples.boundary)
                row.for_outline_samples([&](TangentPath::Rays& rays, const OutlinePoint* const* points,
                                            const SampleLight* lights, int used) {
                    int surfaces[kRays];
                    Vec3d tangents[kRays];
                    float variable[kRays];
                    for (int i = 0; i < kRays; ++i) {
                        variable[i] = lights[i].variable;
                        const Vec3f value = film(lights[i].pixel, lights[i].light, lights[i].weight);
                        const double weight = i < used ? outline_scale * static_cast<double>(value.x) : 0;
                        surfaces[i] = points[i]->surface;
                        tangents[i] = weight * points[i]->tangent;
                        by_stop += weight * points[i]->stop_rate;
                    }
                    const WavelengthsInDouble many = wavelengths(variable);
                    path_.trace(rays, sums, surfaces, tangents, if_dispersed(many));
                });
            append_numbers(path_.derivatives(sums), by_stop, rows[at]);
            unexplained[at] = row.unexplained, edges[at] = row.edge_count;
        },
        keep_going);
    std::vector<double> gradient(number_count());
    for (const std::vector<double>& row : rows)
        for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] += row[i];
    unexplained_ = std::accumulate(unexplained.begin(), unexplained.end(), std::int64_t{0});
    edges_ = std::accumulate(edges.begin(), edges.end(), std::int64_t{0});
    return gradient;
}

std::vector<float> PictureGradient::forward(const std::vector<double>& directions, const float* control,
                                            const GradientSamples& samples, const KeepGoing& keep_going) {
    const std::size_t numbers = number_count(), count = directions.size() / numbers;
    FilmRows film(*this, count);
    const Vec2d per_mm = pixels_per_mm();
    std::vector<TangentPath::Coefficients> along;
    std::vector<double> stop_rates;
    for (std::size_t k = 0; k < count; ++k) {
        const double* direction = directions.data() + k * numbers;
        const double* others = direction + path_.variable_count();
        CameraDerivatives rates;
        rates.by_variable.assign(direction, others);
        std::copy(others, others + 6, rates.by_film.begin());
        std::copy(others + 6, others + 12, rates.by_pose.begin());
        along.push_back(path_.coefficients(rates));
        stop_rates.push_back(others[12]);
    }
    run(
        [&](int row_index) {
            Row row(*this, samples, row_index);
            auto& rows = film.rows_of(row_index);
            TangentPath::Sums sums(path_);
            RayBlock block;
            // Adds light times a factor of each pixel's filter to the derivative pictures.
            const auto add = [&](const SampleLight& sample, std::size_t k, auto&& factor) {
                for_filtered_pixels(filter_, width(), height(), sample.pixel, [&](int pixel, float value, Vec2f slope) {
                    Color light = sample.light;
                    if (control) {
                        const float* c = control + 3 * pixel;
                        light = light - sample.weight * Color{c[0], c[1], c[2]};
                    }
                    film.add(rows, row_index, k, pixel, factor(static_cast<double>(value), slope), light);
                });
            };
            const double scale = exposure_per_sample(samples.spp);
            const auto trace_block = [&] {
                RayBlock other = block;
                for (int i = 0; i < block.count; ++i) block.set_tangent(i, {1, 0}), other.set_tangent(i, {0, 1});
                sums.clear();
                const WavelengthsInDouble many = wavelengths(block.variable);
                path_.trace(block.rays, sums, nullptr, nullptr, if_dispersed(many));
                // Motions of the film points along x and y, for each direction.
                std::vector<std::array<double, kRays>> x(count), y(count);
                for (std::size_t k = 0; k < count; ++k) TangentPath::add_along(along[k], sums, x[k]);
                sums.clear();
                path_.trace(other.rays, sums, nullptr, nullptr, if_dispersed(many));
                for (std::size_t k = 0; k < count; ++k) {
                    TangentPath::add_along(along[k], sums, y[k]);
                    for (std::size_t i = 0; i < static_cast<std::size_t>(block.count); ++i)
                        add(block.lights[i], k, [&](double, Vec2f slope) {
                            return scale * (per_mm.x * x[k][i] * static_cast<double>(slope.x) +
                                            per_mm.y * y[k][i] * static_cast<double>(slope.y));
                        });
                }
                block.count = 0;
            };
            if (samples.interior)
                row.for_film_samples([&](int lane, const SampleLight& sample, const FilmSamples<kLanes>& from) {
                    block.add(sample, film_origin(from.origin[lane]), film_direction(from.direction[lane]));
                    if (block.count == kRays) trace_block();
                });
            if (block.count > 0) trace_block();
            const double outline_scale = exposure_per_sample(samples.outline_spp);
            if (samples.boundary)
                row.for_outline_samples([&](TangentPath::Rays& rays, const OutlinePoint* const* points,
                                            const SampleLight* lights, int used) {
                    int surfaces[kRays];
                    Vec3d tangents[kRays];
                    float variable[kRays];
                    for (int i = 0; i < kRays; ++i) {
                        surfaces[i] = points[i]->surface, tangents[i] = points[i]->tangent;
                        variable[i] = lights[i].variable;
                    }
                    sums.clear();
                    const WavelengthsInDouble many = wavelengths(variable);
                    path_.trace(rays, sums, surfaces, tangents, if_dispersed(many));
                    for (std::size_t k = 0; k < count; ++k) {
                        std::array<double, kRays> speeds{};
                        TangentPath::add_along(along[k], sums, speeds);
                        for (std::size_t i = 0; i < static_cast<std::size_t>(used); ++i) {
                            const double speed = speeds[i] + stop_rates[k] * points[i]->stop_rate;
                            add(lights[i], k, [&](double value, Vec2f) { return outline_scale * speed * value; });
                        }
                    }
                });
        },
        keep_going);
    return film.sum();
}

}  // namespace realcam
