#include <cmath>
#include <limits>
#include <type_traits>

#include "../io/text/printable.hpp"
#include "../render/settings/effect_names.hpp"
#include "../render/settings/setting_names.hpp"
#include "shot_keys.hpp"
#include "shot_table.hpp"

// Settings of a picture: options, keys of shot files, and arguments of RenderSettings in Python.

namespace realcam::shot {
namespace {

using Key = const ShotKey&;
using Shown = const std::string&;
using Request = PictureRequest&;
using Value = const SettingValue&;

/// Returns the member of a request at the end of a path of pointers to members.
template <auto... path>
auto& at(auto& request) {
    return (request.*....*path);
}

template <class Member>
struct IsOptional : std::false_type {};
template <class Member>
struct IsOptional<std::optional<Member>> : std::true_type {};

/// Sets the number at `path`. Without a value, it is removed if it is a std::optional, and otherwise unchanged.
template <auto... path>
void set_number(Key, Shown, Request r, Value value) {
    auto& member = at<path...>(r);
    if (const double* const number = std::get_if<double>(&value))
        member = *number;
    else if constexpr (IsOptional<std::remove_reference_t<decltype(member)>>::value)
        member.reset();
}

/// Sets the whole number at `path`, from `least` to `most`. Without a value, it is removed.
template <std::int64_t least, std::int64_t most, auto... path>
void set_whole(Key key, Shown shown, Request r, Value value) {
    auto& member = at<path...>(r);
    if constexpr (IsOptional<std::remove_reference_t<decltype(member)>>::value) {
        if (std::holds_alternative<std::monostate>(value)) {
            member.reset();
            return;
        }
    }
    const std::int64_t* const whole = std::get_if<std::int64_t>(&value);
    if (!whole || *whole < least || *whole > most)
        throw InputError(shown + " must be a whole number from " + std::to_string(least) + " to " +
                         std::to_string(most) + (key.syntax == Syntax::whole_or_auto ? ", or auto" : ""));
    if constexpr (IsOptional<std::remove_reference_t<decltype(member)>>::value)
        member = *whole;
    else
        member = static_cast<std::remove_reference_t<decltype(member)>>(*whole);
}

template <auto... path>
SettingValue get_value(const PictureRequest& r) {
    const auto to_value = []<class Member>(const Member& member) -> SettingValue {
        if constexpr (std::is_integral_v<Member>)
            return static_cast<std::int64_t>(member);
        else
            return member;
    };
    const auto& member = at<path...>(r);
    if constexpr (!IsOptional<std::remove_cvref_t<decltype(member)>>::value)
        return to_value(member);
    else
        return member ? to_value(*member) : SettingValue();
}

/// Returns the value of a name in `names`.
template <const auto& names>
auto named(std::string_view name) {
    return value_named(names, name);
}

/// Sets the value at `path` by its name, which `find` knows.
template <auto find, auto... path>
void set_named(Key key, Shown shown, Request r, Value value) {
    const std::string& name = std::get<std::string>(value);
    const auto found = find(name);
    if (!found) throw InputError(shown + " must be " + key.wanted + "; it is " + io::in_quotes(name));
    at<path...>(r) = *found;
}

template <const auto& names, auto... path>
SettingValue get_name(const PictureRequest& r) {
    return std::string(name_among(names, at<path...>(r)));
}

/// Sets the choice at `path` by a list of names, which `parse` converts.
template <auto parse, auto... path>
void set_names(Key, Shown shown, Request r, Value value) {
    try {
        at<path...>(r) = parse(std::get<std::vector<std::string>>(value));
    } catch (const InputError& error) {
        throw InputError(shown + ": " + error.what());
    }
}

template <auto... path>
SettingValue get_names(const PictureRequest& r) {
    return names_of(at<path...>(r));
}

/// Sets a std::optional<Spectrum>, an Illuminant or a LensFilter. `from_number`: makes one from a number.
template <class Spectrum, Spectrum (*from_number)(double), auto... path>
void set_spectrum(Key, Shown, Request r, Value value) {
    std::optional<Spectrum>& member = at<path...>(r);
    if (const auto* const text = std::get_if<std::string>(&value))
        member = Spectrum::parse(*text);
    else if (const auto* const number = std::get_if<double>(&value))
        member = from_number(*number);
    else if (const auto* const points = std::get_if<std::vector<SpectrumPoint>>(&value))
        member = Spectrum::table(*points);
    else
        member.reset();
}

template <auto... path>
SettingValue get_spectrum(const PictureRequest& r) {
    const auto& member = at<path...>(r);
    return member ? SettingValue(member->text()) : SettingValue();
}

constexpr std::int64_t kMaxSpp = 1 << 24;  ///< see validate_spp

/// Sets the number of samples, which replaces a noise goal, or lets the noise goal apply.
void set_spp(Key key, Shown shown, Request r, Value value) {
    r.settings.spp = RenderSettings().spp;
    r.sampling = Sampling::by_noise;
    if (std::holds_alternative<std::monostate>(value)) return;
    r.sampling = Sampling::counted;
    r.noise = {};
    set_whole<1, kMaxSpp, &PictureRequest::settings, &RenderSettings::spp>(key, shown, r, value);
}

SettingValue get_spp(const PictureRequest& r) {
    return r.sampling == Sampling::by_noise ? SettingValue() : std::int64_t{r.settings.spp};
}

/// Sets a part of the noise goal, and checks it together with the parts set before.
template <SetSetting set>
void set_noise(Key key, Shown shown, Request r, Value value) {
    set(key, shown, r, value);
    goal_of(r.noise);
}

/// Returns the points [[wavelength_nm, value], ...] of a spectrum; empty if the node has another form.
std::vector<SpectrumPoint> points_in(const toml::node& node) {
    std::vector<SpectrumPoint> points;
    const toml::array* const pairs = node.as_array();
    if (!pairs) return {};
    for (const toml::node& item : *pairs) {
        const toml::array* const pair = item.as_array();
        if (!pair || pair->size() != 2 || !(*pair)[0].is_number() || !(*pair)[1].is_number()) return {};
        points.push_back({(*pair)[0].value_or(0.0), (*pair)[1].value_or(0.0)});
    }
    return points;
}

/// Returns a number as std::int64_t if it is whole; others are refused by set_whole.
SettingValue whole_value(double number) {
    constexpr double kLimit = 0x1p63;
    if (number != std::floor(number) || !(std::fabs(number) < kLimit)) return number;
    return static_cast<std::int64_t>(number);
}

/// Returns the value of a key that the table has.
SettingValue value_in(const ShotTable& t, Key key) {
    switch (key.syntax) {
        case Syntax::number: return *t.number(key.name);
        case Syntax::whole: return whole_value(*t.number(key.name));
        case Syntax::whole_or_auto: {
            const std::optional<double> number = t.number_or_auto(key.name, key.wanted);
            return number ? whole_value(*number) : SettingValue();
        }
        case Syntax::names: return t.texts(key.name);
        case Syntax::spectrum: {
            const toml::node& node = *t.find(key.name);
            if (node.is_number()) return node.value_or(0.0);
            if (node.is_string()) return t.text(key.name);
            std::vector<SpectrumPoint> points = points_in(node);
            if (points.empty())
                t.fail(t.shown(key.name) + " must be " + key.wanted +
                           "; in a shot file a table is [[400, 0.5], [550, 1], [700, 0.2]]",
                       &node);
            return points;
        }
        default: return t.text(key.name);
    }
}

void read_setting(const ShotTable& t, Key key, ShotRequest& r) {
    t.checked(key.name, [&] { key.set(key, t.shown(key.name), r, value_in(t, key)); });
}

/// Reads the name of a part of an OpenColorIO configuration, which a text in the request holds.
template <std::string OcioRequest::* member>
void read_ocio_name(const ShotTable& t, Key key, ShotRequest& r) {
    if (r.ocio.config.empty())
        t.fail(t.shown(key.name) + " belongs to a configuration of OpenColorIO, and \"ocio\" names none",
               t.find(key.name));
    const std::string name = t.name(key.name);
    if (name.empty()) t.fail(t.shown(key.name) + " is empty; expected " + key.wanted, t.find(key.name));
    r.ocio.*member = name;
}

/// Reads the configuration of OpenColorIO. The key precedes those that belong to it.
void read_ocio(const ShotTable& t, Key key, ShotRequest& r) {
    const std::string name = t.name(key.name);
    r.ocio.config = name.starts_with(kBuiltInConfig) ? name : t.path(key.name);
    if (const toml::node* const tone = t.find("tone"))
        t.fail(t.shown("tone") + " and " + t.shown(key.name) + " exclude each other: a view replaces the tone curve",
               tone);
}

void read_exr_color_space(const ShotTable& t, Key key, ShotRequest& r) {
    r.exr_color_space = *t.named(key.name, named<kExrColorSpaces>, key.wanted);
}

void read_tone(const ShotTable& t, Key key, ShotRequest& r) {
    r.tone = *t.named(key.name, named<kToneCurves>, key.wanted);
}

constexpr const char* kGroup = "Picture";

/// Returns the row of a setting of RenderSettings.
ShotKey setting(const char* name, const char* option, const char* placeholder, Syntax syntax, std::string wanted,
                std::string text, const char* initial, std::vector<std::string_view> replaces, SetSetting set,
                SettingValue (*get)(const PictureRequest&) = nullptr, const char* details = "") {
    return {name,
            option,
            kGroup,
            placeholder,
            syntax,
            std::move(wanted),
            std::move(text),
            initial,
            std::move(replaces),
            read_setting,
            nullptr,
            false,
            set,
            get,
            details};
}

using N = NoiseRequest;
using P = PictureRequest;
using S = RenderSettings;
using T = PlanThresholds;

}  // namespace

// clang-format off
std::vector<ShotKey> picture_keys() {
    using enum Syntax;
    constexpr const char *kNumber = "a number", *kWhole = "a whole number";
    return {
        setting("spp", "--spp", "N", whole_or_auto, "a whole number or auto",
         "Samples per pixel; auto: in each tile of the film until the noise goal is reached, by default 1 code",
         "until the noise is 2 codes, for 60 seconds at most", {"noise", "noise_codes", "seconds", "max_spp"},
         set_spp, get_spp, "A tile has 16 x 16 pixels (docs/sampling.md)."),
        setting("noise", "--noise", "FRACTION", number, kNumber,
         "Noise goal, unless spp is a number, as a fraction of a tile's mean, such as 0.01", "", {"noise_codes", "spp"},
         set_noise<set_number<&P::noise, &N::noise>>, get_value<&P::noise, &N::noise>,
         "It is the RMS error of the tile's pixels as a fraction of their mean, or of a hundredth of white if that is "
         "larger."),
        setting("noise_codes", "--noise-codes", "CODES", number, kNumber,
         "Noise goal, unless spp is a number, in 8-bit codes of the picture with the linear tone curve, whatever the "
         "view", "",
         {"noise", "spp"},
         set_noise<set_number<&P::noise, &N::noise_codes>>, get_value<&P::noise, &N::noise_codes>),
        setting("seconds", "--seconds", "SECONDS", number, kNumber,
         "Time limit for taking samples, unless spp is a number", "", {},
         set_noise<set_number<&P::noise, &N::seconds>>, get_value<&P::noise, &N::seconds>,
         "A warning is issued if the noise goal is not reached."),
        setting("max_spp", "--max-spp", "N", whole, kWhole,
         "Largest number of samples per pixel, unless spp is a number", "4096", {},
         set_noise<set_whole<2, kMaxSpp, &P::noise, &N::max_spp>>, get_value<&P::noise, &N::max_spp>),
        setting("filter", "--filter", "NAME", text, one_of(kPixelFilters),
         "Filter of the pixels; box: the pixel's own area; tent: two pixels wide; gaussian: three pixels wide, with a "
         "standard deviation of half a pixel", "box", {},
         set_named<named<kPixelFilters>, &P::settings, &S::filter>, get_name<kPixelFilters, &P::settings, &S::filter>,
         "rc.render_gradient needs a smooth one (docs/picture-derivatives.md)."),
        setting("seed", "--seed", "N", whole, kWhole, "Seed of the random numbers", "0", {},
         set_whole<0, std::numeric_limits<std::uint32_t>::max(), &P::settings, &S::seed>, get_value<&P::settings, &S::seed>, "0 to 2^32 - 1."),
        setting("max_bounces", "--max-bounces", "N", whole_or_auto, "a whole number or auto",
         "Largest number of bounces of light; 0: direct light only", "auto: what the shot calls for", {},
         set_whole<0, kMaxBounces, &P::settings, &S::max_bounces>, get_value<&P::settings, &S::max_bounces>,
         "0 to 64. With auto, threshold_codes decides (docs/plan.md)."),
        setting("transport", "--transport", "NAME", text, one_of(kTransports),
         "paths: all light paths; whitted: direct light, and reflections and refractions of mirrors and smooth glass",
         "paths", {}, set_named<named<kTransports>, &P::settings, &S::transport>,
         get_name<kTransports, &P::settings, &S::transport>),
        setting("clamp_cd_m2", "--clamp", "CD_M2", number, kNumber,
         "Largest radiance of indirect light in any colour channel, in cd/m^2: fewer fireflies, but a picture that is "
         "too dark", "0: no limit", {},
         set_number<&P::settings, &S::clamp>, get_value<&P::settings, &S::clamp>),
        {"tone", "--tone", kGroup, "CURVE", text, one_of(kToneCurves),
         "Tone mapping of developed pictures: film (soft highlights) or linear (clipped)", "film",
         {"ocio", "display", "view"}, read_tone},
        {"ocio", "--ocio", kGroup, "CONFIG", text, "a configuration of OpenColorIO",
         "Configuration of OpenColorIO, a view of which replaces the tone curve: a file, or the name of a built-in one, "
         "such as ocio://studio-config-latest",
         "none", {"tone", "display", "view", "environment_color_space", "texture_color_space"}, read_ocio, nullptr,
         false, nullptr, nullptr, "The variable OCIO of the environment is not read (docs/colour.md)."},
        {"display", "--display", kGroup, "NAME", text, "the name of a display of the configuration",
         "Display of the OpenColorIO configuration", "the configuration's", {"view"},
         read_ocio_name<&OcioRequest::display>},
        {"view", "--view", kGroup, "NAME", text, "the name of a view of the display",
         "View of the OpenColorIO configuration", "the display's", {}, read_ocio_name<&OcioRequest::view>},
        {"environment_color_space", "--environment-color-space", kGroup, "NAME", text,
         "the name of a colour space of the configuration, or file_rules",
         "Colour space of the environment's picture in the OpenColorIO configuration; file_rules: by its file's name",
         "as the picture states", {}, read_ocio_name<&OcioRequest::environment_color_space>},
        {"texture_color_space", "--texture-color-space", kGroup, "NAME", text,
         "the name of a colour space of the configuration, or file_rules",
         "Colour space of colour textures in the OpenColorIO configuration; file_rules: by their files' names",
         "as each picture states", {},
         read_ocio_name<&OcioRequest::texture_color_space>},
        {"exr_color_space", "--exr-color-space", kGroup, "NAME", text, one_of(kExrColorSpaces),
         "Colour space of .exr files: linear Rec. 709 or ACEScg", "rec709", {}, read_exr_color_space},
        setting("layers", "--layers", "NAMES", names, "names (docs/layers.md)",
         "Layers also written to .exr, separated by commas: all, or some of " + layer_names(), "none", {},
         set_names<layers_named, &P::settings, &S::layers>, get_names<&P::settings, &S::layers>,
         "A list in shot files. all does not include dual_pixel (docs/layers.md)."),
        setting("effects", "--effects", "NAMES", names, "names (rc.effects() lists them)",
         "Effects to simulate or, with a minus, to leave out, as in --effects=auto,ghosts,-motion_blur: " +
             effect_names(),
         "auto: what the shot calls for", {},
         set_names<effects_named, &P::settings, &S::effects>, get_names<&P::settings, &S::effects>,
         "A list in shot files, such as [\"dispersion\", \"-motion_blur\"]; the empty list switches all effects off. With "
         "auto, the planner also selects the cheapest camera model that shows the effects (docs/plan.md). A warning is "
         "issued for effects that the lens cannot show."),
        setting("quality", "--quality", "NAME", text, kQualityNames,
         "Size below which effects are left out by auto: draft (2 pixels, 4 codes), photo (0.5, 1) or reference (0.1, "
         "0.25)", "photo", {"threshold_px", "threshold_codes"},
         set_named<quality_named, &P::settings, &S::thresholds>),
        setting("threshold_px", "--threshold-px", "PIXELS", number, kNumber,
         "Threshold in pixels that replaces that of the quality", "", {},
         set_number<&P::settings, &S::thresholds, &T::pixels>,
         get_value<&P::settings, &S::thresholds, &T::pixels>),
        setting("threshold_codes", "--threshold-codes", "CODES", number, kNumber,
         "Threshold in 8-bit codes that replaces that of the quality", "", {},
         set_number<&P::settings, &S::thresholds, &T::codes>,
         get_value<&P::settings, &S::thresholds, &T::codes>),
        setting("illuminant", "--illuminant", "SPECTRUM", spectrum,
         "a name, a wavelength in nm or (wavelength_nm, power) pairs",
         "Spectrum of all light, for " + effects_that(&EffectInfo::has_wavelengths) + ": " +
             std::string(Illuminant::kWanted), "D65", {},
         set_spectrum<Illuminant, &Illuminant::line, &P::settings, &S::illuminant>,
         get_spectrum<&P::settings, &S::illuminant>,
         "Points are a list of pairs in shot files and in Python (docs/dispersion.md)."),
        setting("lens_filter", "--lens-filter", "FILTER", spectrum,
         "a text such as ND8, a transmittance or (wavelength_nm, transmittance) pairs",
         "Filter in front of the lens: " + std::string(LensFilter::kWanted), "none", {},
         set_spectrum<LensFilter, &LensFilter::neutral, &P::settings, &S::lens_filter>,
         get_spectrum<&P::settings, &S::lens_filter>,
         "A coloured filter needs dispersion or diffraction (docs/filters.md)."),
        setting("pupil_sampling", nullptr, "NAME", text, one_of(kPupilSamplings),
         "Part of the pupil to which the full lens's rays are sent; outline: the region through which real rays pass",
         "outline", {}, set_named<named<kPupilSamplings>, &P::settings, &S::pupil_sampling>,
         get_name<kPupilSamplings, &P::settings, &S::pupil_sampling>,
         "The others are for comparison (docs/accuracy.md): rear_element, exit_pupil, and pixel, the region in which "
         "the pixel's earlier samples passed."),
        setting("light_tracing", nullptr, "NAME", text, one_of(kLightTracings),
         "Method for the full lens's images of lights that are small or out of focus; weighted: samples of pixels and "
         "samples from the lights, combined by multiple importance sampling",
         "weighted", {}, set_named<named<kLightTracings>, &P::settings, &S::light_tracing>,
         get_name<kLightTracings, &P::settings, &S::light_tracing>,
         "The others are for comparison: alone: samples from the lights; off: samples of pixels, which never hit point "
         "lights and suns."),
        setting("threads", "--threads", "N", whole, kWhole, "Number of threads; 0: all", "0", {},
         set_whole<0, kMaxThreads, &P::settings, &S::threads>, get_value<&P::settings, &S::threads>),
    };
}
// clang-format on

PictureRequest request_of(const RenderSettings& settings) {
    PictureRequest request{settings, settings.noise ? Sampling::by_noise : Sampling::counted, {}};
    if (const std::optional<NoiseGoal>& goal = settings.noise) {
        (goal->unit == NoiseUnit::codes ? request.noise.noise_codes : request.noise.noise) = goal->noise;
        if (std::isfinite(goal->seconds)) request.noise.seconds = goal->seconds;
        request.noise.max_spp = goal->max_samples;
    }
    return request;
}

}  // namespace realcam::shot
