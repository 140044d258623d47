#include "picture_gradient.hpp"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "gradient_row.hpp"
#include "lens_rays.hpp"

namespace realcam {

PictureGradient::PictureGradient(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                                 std::vector<LensVariable> variables)
    : CameraGradient(scene, camera, settings, std::move(variables), fast_pupil_tracer()),
      embree_(std::make_unique<const EmbreeParts>(scene, camera)),
      view_(setup_->view(embree_->scene.placed().origin_m(), embree_->scene.placed().moves())) {
    scene_moves_ = embree_->scene.placed().moves();
}

PictureGradient::~PictureGradient() = default;

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
    int first_row(int row) const { return row - of_.film_.margin - 2; }
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

WavelengthsInDouble PictureGradient::wavelengths(const float* variable) const {
    return {view_.dispersion.to_scene, variable};
}

const WavelengthsInDouble* PictureGradient::if_dispersed(const WavelengthsInDouble& many) const {
    return view_.effects.dispersion ? &many : nullptr;
}

template <int M>
void PictureGradient::trace_film(RayBlock<M>& block, TangentPath::Sums& sums) const {
    block.complete();
    const WavelengthsInDouble many = wavelengths(block.variable);
    path_.trace(block.rays, sums, nullptr, nullptr, if_dispersed(many));
}

template <int M>
void PictureGradient::trace_outline(const OutlineBlock& block, const double (&weights)[kRays][M],
                                    TangentPath::Sums& sums) const {
    int surfaces[kRays];
    Vec3d tangents[M * kRays];
    float variable[kRays];
    for (int i = 0; i < kRays; ++i) {
        surfaces[i] = block.points[i]->surface;
        for (int m = 0; m < M; ++m) tangents[M * i + m] = weights[i][m] * block.points[i]->tangent;
        variable[i] = block.lights[i].variable;
    }
    const WavelengthsInDouble many = wavelengths(variable);
    TangentRays<kRays, M> rays;
    static_cast<LensRays<double, kRays>&>(rays) = block.rays;
    path_.trace(rays, sums, surfaces, tangents, if_dispersed(many));
}

std::vector<float> PictureGradient::picture(const GradientSamples& samples, const KeepGoing& keep_going) {
    FilmRows film(*this, 1);
    const double scale = exposure_per_sample(samples.spp);
    run(
        [&](int row_index) {
            Row row(*this, samples, row_index);
            auto& rows = film.rows_of(row_index);
            row.for_film_samples([&](int, const SampleLight& sample, const FilmSamples<kLanes>&) {
                for_filtered_pixels(
                    settings_.filter, width(), height(), sample.pixel, [&](int pixel, float value, Vec2f) {
                        film.add(rows, row_index, 0, pixel, scale * static_cast<double>(value), sample.light);
                    });
            });
        },
        keep_going);
    return film.sum();
}

std::vector<double> PictureGradient::reverse(const float* adjoint, const float* control, const GradientSamples& samples,
                                             const KeepGoing& keep_going) {
    const std::vector<float> of_control = adjoint_of_control(adjoint, control);
    const AdjointFilm film{settings_.filter, width(), height(), adjoint, control ? of_control.data() : nullptr};
    return control ? reverse_along<2>(film, samples, keep_going) : reverse_along<1>(film, samples, keep_going);
}

template <int M>
std::vector<double> PictureGradient::reverse_along(const AdjointFilm& film, const GradientSamples& samples,
                                                   const KeepGoing& keep_going) {
    // Sums of the rows, which are added in order, make the result independent of the number of threads.
    std::vector<std::vector<double>> rows(static_cast<std::size_t>(view_.height));
    std::vector<std::int64_t> unexplained(rows.size()), edges(rows.size());
    const Vec2d per_mm = pixels_per_mm();
    run(
        [&](int row_index) {
            const auto at = static_cast<std::size_t>(row_index);
            Row row(*this, samples, row_index);
            TangentPath::Sums sums(path_);
            RayBlock<M> block;
            const double scale = exposure_per_sample(samples.spp);
            if (samples.interior)
                row.for_film_samples([&](int lane, const SampleLight& sample, const FilmSamples<kLanes>& from) {
                    const std::array<Vec3f, M> changes = film.changes<M>(sample.pixel, sample.light, sample.weight);
                    if (!has_gradient(changes)) return;
                    block.add(sample, outline_.view(), from.origin[lane], from.direction[lane]);
                    for (int m = 0; m < M; ++m) {
                        const Vec3f change = changes[static_cast<std::size_t>(m)];
                        set_film_tangent(block.rays, block.count - 1, m,
                                         {scale * per_mm.x * static_cast<double>(change.y),
                                          scale * per_mm.y * static_cast<double>(change.z)});
                    }
                    if (block.count == kRays) trace_film(block, sums), block.count = 0;
                });
            if (block.count > 0) trace_film(block, sums);
            const double outline_scale = exposure_per_sample(samples.outline_spp);
            double by_stop = 0, by_rims = 0;
            if (samples.boundary)
                row.for_outline_samples([&](const OutlineBlock& outline) {
                    double weights[kRays][M] = {};
                    for (int i = 0; i < outline.count; ++i) {
                        const SampleLight& light = outline.lights[i];
                        const std::array<Vec3f, M> changes = film.changes<M>(light.pixel, light.light, light.weight);
                        for (int m = 0; m < M; ++m)
                            weights[i][m] = outline_scale * static_cast<double>(changes[static_cast<std::size_t>(m)].x);
                        by_stop += weights[i][0] * outline.points[i]->stop_rate;
                        by_rims += weights[i][0] * outline.points[i]->rim_rate;
                    }
                    trace_outline(outline, weights, sums);
                });
            rows[at] = by_all_numbers(path_.derivatives(sums), by_stop, by_rims);
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

/// Direction in the space of the camera's numbers, in forward mode.
struct PictureGradient::Direction {
    TangentPath::Coefficients all, pose;  ///< coefficients by all numbers, and by those of the pose alone
    double stop_rate, rim_rate;
};

/// Motions of the samples of a block along a direction.
struct PictureGradient::Motions {
    std::array<double, kRays> all{}, pose{};

    Motions(const Direction& along, const TangentPath::Sums& sums) {
        TangentPath::add_along(along.all, sums, all);
        TangentPath::add_along(along.pose, sums, pose);
    }
};

std::vector<float> PictureGradient::forward(const std::vector<double>& directions, const float* control,
                                            const GradientSamples& samples, const KeepGoing& keep_going) {
    const std::size_t numbers = number_count(), count = directions.size() / numbers;
    FilmRows film(*this, count);
    const Vec2d per_mm = pixels_per_mm();
    std::vector<Direction> along;
    for (std::size_t k = 0; k < count; ++k) {
        const double* direction = directions.data() + k * numbers;
        const double* others = direction + path_.variable_count();
        CameraDerivatives rates;
        rates.by_variable.assign(path_.variable_count(), 0);
        std::copy(others + 6, others + 12, rates.by_pose.begin());
        const TangentPath::Coefficients of_pose = path_.coefficients(rates);
        rates.by_variable.assign(direction, others);
        std::copy(others, others + 6, rates.by_film.begin());
        along.push_back({path_.coefficients(rates), of_pose, others[12], others[13]});
    }
    run(
        [&](int row_index) {
            Row row(*this, samples, row_index);
            auto& rows = film.rows_of(row_index);
            TangentPath::Sums sums(path_);
            RayBlock<1> block;
            // Adds light to the derivative picture k. `factor`: factor of each pixel's light, and of its control
            // variate.
            const auto add = [&](const SampleLight& sample, std::size_t k, auto&& factor) {
                for_filtered_pixels(
                    settings_.filter, width(), height(), sample.pixel, [&](int pixel, float value, Vec2f slope) {
                        const auto [of_light, of_control] = factor(static_cast<double>(value), slope);
                        film.add(rows, row_index, k, pixel, of_light, sample.light);
                        if (!control) return;
                        const float* c = control + 3 * pixel;
                        film.add(rows, row_index, k, pixel, -of_control, sample.weight * Color{c[0], c[1], c[2]});
                    });
            };
            const double scale = exposure_per_sample(samples.spp);
            const auto trace_block = [&] {
                RayBlock<1> other = block;
                for (int i = 0; i < block.count; ++i) {
                    set_film_tangent(block.rays, i, 0, {1, 0});
                    set_film_tangent(other.rays, i, 0, {0, 1});
                }
                sums.clear();
                trace_film(block, sums);
                // Motions of the film points along x and y, for each direction.
                std::vector<Motions> x, y;
                for (const Direction& direction : along) x.emplace_back(direction, sums);
                sums.clear();
                trace_film(other, sums);
                for (const Direction& direction : along) y.emplace_back(direction, sums);
                for (std::size_t k = 0; k < count; ++k)
                    for (std::size_t i = 0; i < static_cast<std::size_t>(block.count); ++i)
                        add(block.lights[i], k, [&](double, Vec2f slope) {
                            const double by_x = scale * per_mm.x * static_cast<double>(slope.x),
                                         by_y = scale * per_mm.y * static_cast<double>(slope.y);
                            return std::pair(by_x * x[k].all[i] + by_y * y[k].all[i],
                                             by_x * x[k].pose[i] + by_y * y[k].pose[i]);
                        });
                block.count = 0;
            };
            if (samples.interior)
                row.for_film_samples([&](int lane, const SampleLight& sample, const FilmSamples<kLanes>& from) {
                    block.add(sample, outline_.view(), from.origin[lane], from.direction[lane]);
                    if (block.count == kRays) trace_block();
                });
            if (block.count > 0) trace_block();
            const double outline_scale = exposure_per_sample(samples.outline_spp);
            if (samples.boundary)
                row.for_outline_samples([&](const OutlineBlock& outline) {
                    double weights[kRays][1];
                    for (auto& weight : weights) weight[0] = 1;
                    sums.clear();
                    trace_outline(outline, weights, sums);
                    for (std::size_t k = 0; k < count; ++k) {
                        const Motions speeds(along[k], sums);
                        for (std::size_t i = 0; i < static_cast<std::size_t>(outline.count); ++i) {
                            const OutlinePoint& point = *outline.points[i];
                            const double speed = speeds.all[i] + along[k].stop_rate * point.stop_rate +
                                                 along[k].rim_rate * point.rim_rate;
                            add(outline.lights[i], k, [&](double value, Vec2f) {
                                return std::pair(outline_scale * speed * value, outline_scale * speeds.pose[i] * value);
                            });
                        }
                    }
                });
        },
        keep_going);
    return film.sum();
}

}  // namespace realcam
