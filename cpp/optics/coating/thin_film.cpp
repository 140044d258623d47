#include "thin_film.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace realcam {

namespace thin_film_detail {

namespace {

/// Returns exp(z) - 1 without cancellation near 0.
Complex expm1(Complex z) {
    const double half_sine = std::sin(z.imag() / 2);
    return {std::expm1(z.real()) * std::cos(z.imag()) - 2 * half_sine * half_sine,
            std::exp(z.real()) * std::sin(z.imag())};
}

/// Returns n cos(angle) in a medium of refractive index `index`, which is the normal component of the wave vector over
/// the vacuum wave number. `cosine`: cosine of the angle of incidence in the incident medium, of index `index_before`.
/// In an absorbing medium, and for an evanescent wave, the result is that of the decaying wave.
Complex normal_component(Complex index, double index_before, double cosine) {
    // n'^2 - n^2 sin^2 in a form that does not cancel at grazing incidence.
    const Complex square =
        (index - index_before) * (index + index_before) + index_before * index_before * cosine * cosine;
    const Complex root = std::sqrt(square);
    return root.imag() < 0 ? -root : root;
}

/// Tangential fields at one plane: electric (u) and magnetic (v) for s, magnetic and electric for p. The admittance is
/// v / u.
struct TangentialFields {
    Complex u, v;
};

/// Returns the fields in front of a film from those behind it, divided by exp(-i delta), which grows without limit in a
/// thick absorbing film. `wave_number`: 2 pi / wavelength, 1/nm; `component`: normal_component in the film; `scale`: 1
/// for s, 1 / index^2 for p, so that component * scale is the admittance y of the film. With h = (1 - exp(2 i d)) / 2,
/// d = delta, the characteristic matrix {{cos d, -i sin d / y}, {-i y sin d, cos d}} divided by exp(-i d) is
/// {{1 - h, h / y}, {y h, 1 - h}}.
TangentialFields through_film(TangentialFields behind, const FilmStack::Film& film, double wave_number,
                              Complex component, Complex scale) {
    const Complex delta = wave_number * film.thickness_nm * component;
    const Complex h = -0.5 * expm1(Complex(0, 2) * delta);
    const Complex y = component * scale;
    // At the film's critical angle both h and y are 0, and h / y tends to -i k d / scale.
    const Complex quotient = component == Complex(0) ? Complex(0, -wave_number * film.thickness_nm) / scale : h / y;
    return {(1.0 - h) * behind.u + quotient * behind.v, y * h * behind.u + (1.0 - h) * behind.v};
}

/// Returns the response to one polarisation. `cosine`: cosine of the angle of incidence, above 0.
SurfaceResponse response(const FilmStack& stack, double cosine, bool is_p) {
    const double before = stack.index_before, wave_number = 2 * std::numbers::pi / stack.wavelength_nm;
    const auto scale_in = [&](Complex index) { return is_p ? 1.0 / (index * index) : Complex(1); };
    const Complex component_behind = normal_component(stack.index_behind, before, cosine);
    const Complex y_behind = component_behind * scale_in(stack.index_behind);
    const double y_before = is_p ? cosine / before : cosine * before;
    TangentialFields fields{1, y_behind};
    Complex passed = 1;  // the transmitted field, divided by all that `fields` is divided by
    for (std::size_t i = stack.films.size(); i-- > 0;) {
        const FilmStack::Film& film = stack.films[i];
        const Complex component = normal_component(film.index, before, cosine);
        fields = through_film(fields, film, wave_number, component, scale_in(film.index));
        passed *= std::exp(Complex(0, wave_number * film.thickness_nm) * component);
        // A highly reflecting stack of some hundred films would otherwise leave the range of double.
        const double size = std::max(std::abs(fields.u), std::abs(fields.v));
        constexpr double kLargeField = 1e100;
        if (size > kLargeField) {
            fields = {fields.u / size, fields.v / size};
            passed /= size;
        }
    }
    const Complex sum = y_before * fields.u + fields.v;
    // Powers relative to that of the incident wave are these fluxes times `unit`.
    const double norm = std::norm(sum), unit = 4 * y_before / norm;
    const double flux_out = y_behind.real() * std::norm(passed);
    SurfaceResponse result{};
    result.r = (y_before * fields.u - fields.v) / sum;
    result.t = 2 * y_before * passed / sum;
    if (is_p) result.t *= before / stack.index_behind;  // from the magnetic to the electric field
    result.reflectance = std::norm(y_before * fields.u - fields.v) / norm;
    result.transmittance = unit * flux_out;
    // Power flowing in minus power flowing out, clamped: rounding must not turn it into a gain in a lossless stack.
    result.absorptance = std::max(0.0, unit * ((fields.u * std::conj(fields.v)).real() - flux_out));
    return result;
}

}  // namespace

}  // namespace thin_film_detail

PolarisedResponse response_of(const FilmStack& stack, double cosine) {
    // At cosine 0 no power flows through the surface, so that its fractions are undefined; no ray comes closer to
    // grazing than 1e-100.
    const double above_0 = std::clamp(cosine, 1e-100, 1.0);
    return {thin_film_detail::response(stack, above_0, false), thin_film_detail::response(stack, above_0, true)};
}

}  // namespace realcam
