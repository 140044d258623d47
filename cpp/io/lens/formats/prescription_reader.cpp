#include "prescription_reader.hpp"

#include <cmath>

#include "../../text/printable.hpp"

namespace realcam::io {

PrescriptionReader::PrescriptionReader(const char* format, const std::string& file, LensGlasses& glasses)
    : glasses_(glasses) {
    p_.file = file;
    p_.format = format;
}

void PrescriptionReader::add_unsupported(const std::string& text, int line, int surface) {
    if (unsupported_.emplace(text, surface).second) p_.unsupported.push_back({text, line, surface});
}

void PrescriptionReader::remark(const std::string& text) {
    if (remarks_.insert(text).second) p_.remarks.push_back(text);
}

void PrescriptionReader::set_object(double distance, double curvature, int line) {
    p_.object_distance = distance >= kLongest ? kInfinity : distance;
    if (curvature != 0 && std::isfinite(p_.object_distance)) add_unsupported("a curved object", line, 0);
}

void PrescriptionReader::set_wavelengths(std::vector<double> wavelengths_nm, std::size_t main) {
    if (wavelengths_nm.empty()) return remark("it specifies no wavelength; the d line is assumed");
    p_.wavelength_nm = wavelengths_nm[main];
    p_.wavelengths_nm = std::move(wavelengths_nm);
}

std::string LensCommand::upper(std::size_t i, std::size_t max_length) const {
    return i < size() ? upper_case(values_[i].text.substr(0, max_length)) : std::string();
}

double LensCommand::number(std::size_t i, const std::string& name) const {
    if (i >= size()) lines_.fail(name + " is missing");
    return lines_.number_of(values_[i].text, name);
}

double LensCommand::number_or(std::size_t i, const std::string& name, double default_value) const {
    return i < size() && !values_[i].is_quoted ? number(i, name) : default_value;
}

double LensCommand::number_or_infinity(std::size_t i, const std::string& name) const {
    if (i < size() && is_infinity(values_[i].text)) return values_[i].text.starts_with('-') ? -kInfinity : kInfinity;
    return number(i, name);
}

std::vector<double> LensCommand::numbers(std::size_t first, const std::string& name) const {
    std::vector<double> list;
    for (std::size_t i = first; i < size(); ++i) list.push_back(number(i, "each value of " + name));
    return list;
}

int LensCommand::whole(std::size_t i, const std::string& name, int min, int max) const {
    if (i >= size()) lines_.fail(name + " is missing");
    return lines_.whole_number_of(values_[i].text, name, min, max);
}

void PrescriptionText::add_unknown_keyword(std::string_view word) {
    if (unknown_.size() < kMaxUnknownWords) unknown_.insert(printable(word.substr(0, 40)));
}

void PrescriptionText::remark_unknown_keywords(const std::string& subject) {
    if (!unknown_.empty()) remark("unknown " + subject + " are ignored: " + short_list(unknown_));
}

std::vector<double> PrescriptionText::field_values(const LensCommand& command) const {
    if (command.size() > kMaxFileFields)
        lines_.fail(command.word + " has more than " + std::to_string(kMaxFileFields) + " values");
    return command.numbers(0, command.word);
}

void PrescriptionText::check_count(std::size_t surfaces) const {
    if (surfaces >= kMaxFileSurfaces)
        lines_.fail("the file has more than " + std::to_string(kMaxFileSurfaces) + " surfaces");
}

std::optional<double> millimetres_of(const std::string& unit) {
    static const std::map<std::string, double> units{{"MM", 1},    {"CM", 10},     {"M", 1000},      {"METER", 1000},
                                                     {"IN", 25.4}, {"INCH", 25.4}, {"INCHES", 25.4}, {"METERS", 1000}};
    const auto found = units.find(unit);
    return found == units.end() ? std::nullopt : std::optional(found->second);
}

void add_term(PrescriptionSurface& row, int power, double value, double unit) {
    if (value != 0) row.aspheric[power] += value * std::pow(unit, 1 - power);
}

std::pair<int, int> xy_powers(int number) {
    int power_of_y = number, degree = 0;
    while (power_of_y > degree) power_of_y -= ++degree;
    return {degree - power_of_y, power_of_y};
}

void set_zernike(PrescriptionSurface& row, ZernikeOrder order, double radius, std::vector<double> coefficients) {
    while (!coefficients.empty() && coefficients.back() == 0) coefficients.pop_back();
    if (!coefficients.empty()) row.form.zernike = ZernikeTerms{order, radius, std::move(coefficients)};
}

void set_outline(ApertureShape& shape, bool is_circle, bool is_rectangle, Vec2d half, Vec2d offset) {
    shape.kind = is_circle      ? ApertureOutline::circle
                 : is_rectangle ? ApertureOutline::rectangle
                                : ApertureOutline::ellipse;
    shape.half = half;
    shape.offset = offset;
}

void limit_to_outline(PrescriptionSurface& row) {
    const double reach = row.aperture_shape.reach();
    if (!(reach > 0)) return;
    row.clear_semi_diameter = row.clear_semi_diameter > 0 ? std::min(row.clear_semi_diameter, reach) : reach;
}

std::vector<Vec2d> rotated_rectangle(Vec2d half, double angle_deg) {
    const Affine<double> frame = rotation(0, 0, angle_deg);
    std::vector<Vec2d> corners;
    for (const auto& [x, y] : {Vec2d{1, 1}, Vec2d{-1, 1}, Vec2d{-1, -1}, Vec2d{1, -1}}) {
        const Vec3d corner = frame.direction({x * half.x, y * half.y, 0});
        corners.push_back({corner.x, corner.y});
    }
    return corners;
}

Glass glass_of_indices(const std::vector<double>& wavelengths_nm, const std::vector<double>& indices,
                       std::string label) {
    std::vector<Glass::TablePoint> points;
    for (std::size_t i = 0; i < indices.size(); ++i) points.push_back({wavelengths_nm[i], indices[i]});
    Glass glass = Glass::table(std::move(points));
    glass.label = std::move(label);
    return glass;
}

void set_decentre(const SurfacePlacement& placement, DecentreKind kind, PrescriptionSurface& row) {
    row.before = row.behind = {};
    if (placement.is_in_place()) return;
    const Affine<double> frame = placement.frame();
    if (kind != DecentreKind::reverse) row.before = frame;
    if (kind == DecentreKind::and_return || kind == DecentreKind::reverse) row.behind = inverse_motion(frame);
    if (kind == DecentreKind::bend) row.behind = SurfacePlacement{{}, placement.tilt_deg, false}.frame();
}

void swap_toroid_axes(PrescriptionSurface& row) {
    const Affine<double> quarter_turn = rotation(0, 0, 90);
    row.before = row.before * quarter_turn;
    row.behind = inverse_motion(quarter_turn) * row.behind;
    ApertureShape& shape = row.aperture_shape;
    const auto rotated = [](Vec2d v) { return Vec2d{v.y, -v.x}; };
    std::swap(shape.half.x, shape.half.y);
    shape.offset = rotated(shape.offset);
    for (Vec2d& corner : shape.corners) corner = rotated(corner);
    for (Obscuration& piece : shape.obscurations) {
        piece.offset = rotated(piece.offset);
        piece.angle_deg -= 90;
    }
}

}  // namespace realcam::io
