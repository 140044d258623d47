#include "field_fan.hpp"

#include <cmath>
#include <numeric>

#include "../analysis/ray_aiming.hpp"

namespace realcam {

namespace {

constexpr int kFanLanes = 16;  ///< rays that are traced together

}  // namespace

FieldFan::FieldFan(const LensSystem& nominal, double wavelength_nm, const FieldPoint& field, double azimuth_cos,
                   double azimuth_sin, int rings, const RayLoop& loop)
    : object_(nominal, wavelength_nm, field), cos_(azimuth_sin), sin_(-azimuth_cos) {
    const RayAimer aim(nominal, wavelength_nm, field);
    chief_ = aim.chief_ray().entry;
    const double reach = stop_bounding_radius(nominal);
    const std::vector<PupilPoint> pattern = gauss_rings(rings);
    const std::vector<AimedRay> rays = aim_all(aim, pattern, reach, loop);
    // Least-squares fit of a linear map from the stop to the entry plane. Cross terms are necessary, because rays that
    // are missing make the pattern asymmetric.
    double xx = 0, xy = 0, yy = 0;
    Vec2<double> of_x{0, 0}, of_y{0, 0};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec2<double> entry = rays[i].entry;
        if (!std::isfinite(entry.x + entry.y)) continue;
        entries_.push_back(entry);
        weights_.push_back(pattern[i].weight);
        const double x = reach * pattern[i].x, y = reach * pattern[i].y;
        xx += x * x, xy += x * y, yy += y * y;
        const double ex = entry.x - chief_.x, ey = entry.y - chief_.y;
        of_x.x += ex * x, of_x.y += ex * y, of_y.x += ey * x, of_y.y += ey * y;
    }
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0))
        throw InputError("no rays at a field angle of " + object_point_detail::degrees(field.angle_rad) +
                         " reach the stop of lens \"" + nominal.name + "\"");
    by_x_ = {(of_x.x * yy - of_x.y * xy) / determinant, (of_y.x * yy - of_y.y * xy) / determinant};
    by_y_ = {(of_x.y * xx - of_x.x * xy) / determinant, (of_y.y * xx - of_y.x * xy) / determinant};
    // The last lanes are filled with chief rays of weight 0.
    while (entries_.size() % kFanLanes != 0) {
        entries_.push_back(chief_);
        weights_.push_back(0);
    }
}

double FieldFan::total_weight() const {
    return std::accumulate(weights_.begin(), weights_.end(), 0.0);
}

Vec2<double> FieldFan::to_azimuth(Vec2<double> v) const {
    return {cos_ * v.x - sin_ * v.y, sin_ * v.x + cos_ * v.y};
}

Vec2<double> FieldFan::from_azimuth(Vec2<double> v) const {
    return {cos_ * v.x + sin_ * v.y, -sin_ * v.x + cos_ * v.y};
}

template <int N>
void FieldFan::start(const CopyPath::WavelengthView& copy, const Vec2<double>* entries,
                     LensRays<double, N>& rays) const {
    for (int i = 0; i < N; ++i) {
        const Vec3d at = object_.at(entries[i]), direction = object_.direction(entries[i]);
        const Vec2<double> position = to_azimuth({at.x, at.y}), across = to_azimuth({direction.x, direction.y});
        rays.origin.set(i, {position.x, position.y, at.z - copy.entry_position});
        rays.direction.set(i, copy.entry_index * Vec3d{across.x, across.y, direction.z});
        rays.status[i] = 0;
    }
}

Vec2<double> FieldFan::chief_ray_miss(const CopyPath::WavelengthView& copy, int stop) const {
    LensView<double> to_stop = copy.view;
    to_stop.count = stop + 1;
    // Two lanes, because the trace of a single ray ends at the first rim that blocks it.
    const Vec2<double> entries[2] = {chief_, chief_};
    LensRays<double, 2> rays;
    start<2>(copy, entries, rays);
    trace_lens(to_stop, rays);
    return from_azimuth({rays.origin.x[0], rays.origin.y[0]});
}

FieldFan::Traced FieldFan::trace_copy(const CopyPath::WavelengthView& copy, int stop, bool with_rays) const {
    const Vec2<double> miss = chief_ray_miss(copy, stop);
    const Vec2<double> move = {-(by_x_.x * miss.x + by_y_.x * miss.y), -(by_x_.y * miss.x + by_y_.y * miss.y)};
    const LensView<double> view = copy.view;
    const auto at_vertex = [](const auto& rays, int i, double weight) {
        const Vec3d o = rays.origin[i], d = rays.direction[i];
        const Vec2<double> slope{d.x / d.z, d.y / d.z};
        const Vec2<double> at{o.x - o.z * slope.x, o.y - o.z * slope.y};
        const bool passes = rays.status[i] == 0 && std::isfinite(at.x + at.y + slope.x + slope.y);
        return FilmRay{at, slope, passes ? weight : 0.0};
    };
    Traced traced;
    const Vec2<double> chief{chief_.x + move.x, chief_.y + move.y};
    const Vec2<double> chiefs[2] = {chief, chief};
    LensRays<double, 2> pair;
    start<2>(copy, chiefs, pair);
    trace_lens(view, pair);
    traced.chief = at_vertex(pair, 0, 1);
    if (!with_rays) return traced;
    traced.rays.reserve(entries_.size());
    for (std::size_t first = 0; first < entries_.size(); first += kFanLanes) {
        Vec2<double> entries[kFanLanes];
        for (std::size_t i = 0; i < kFanLanes; ++i)
            entries[i] = {entries_[first + i].x + move.x, entries_[first + i].y + move.y};
        LensRays<double, kFanLanes> rays;
        start<kFanLanes>(copy, entries, rays);
        trace_lens(view, rays);
        for (int i = 0; i < kFanLanes; ++i)
            if (const double weight = weights_[first + static_cast<std::size_t>(i)]; weight > 0)
                traced.rays.push_back(at_vertex(rays, i, weight));
    }
    return traced;
}

CopyPath::CopyPath(const LensSystem& lens, const std::vector<double>& wavelengths_nm)
    : first_(lens, LightDirection::to_film, wavelengths_nm.front()) {
    const std::vector<Crossing> crossings = crossings_of(lens);
    const LensView<double> view = first_.view();
    for (const double wavelength : wavelengths_nm) {
        const std::vector<double> indices = lens.indices(wavelength);
        std::vector<SurfaceView<double>>& surfaces = surfaces_.emplace_back(view.surfaces, view.surfaces + view.count);
        for (std::size_t k = 0; k < surfaces.size(); ++k) {
            const double before = crossings[k].index_before(indices), behind = crossings[k].index_behind(indices);
            surfaces[k].index_squared = before * before;
            surfaces[k].squared_index_change = (behind - before) * (behind + before) / (before * before);
        }
        entry_indices_.push_back(indices.front());
    }
}

CopyPath::WavelengthView CopyPath::at(std::size_t wavelength) const {
    LensView<double> view = first_.view();
    view.surfaces = surfaces_[wavelength].data();
    return {view, first_.entry_position, entry_indices_[wavelength]};
}

}  // namespace realcam
