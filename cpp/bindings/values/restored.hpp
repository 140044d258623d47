#pragma once
#include <pybind11/numpy.h>

#include <concepts>
#include <cstring>
#include <initializer_list>
#include <type_traits>
#include <vector>

#include "../../camera/film/camera.hpp"
#include "../../camera/film/camera_key.hpp"
#include "../../camera/film/shake.hpp"
#include "../../camera/sensor/sensor.hpp"
#include "../../cuda/device/shared_device_array.hpp"
#include "../../error.hpp"
#include "../../optics/prescription/coating_checks.hpp"
#include "../../optics/prescription/form_checks.hpp"
#include "../../optics/prescription/lens_checks.hpp"
#include "../../optics/trace/lens_rays.hpp"
#include "../../scene/scene_checks.hpp"
#include "material.hpp"
#include "value_compare.hpp"

namespace realcam::bindings {

// Validation of unpickled values. A pickle is untrusted input: it holds the members of a value, and these are checked
// as the arguments of a constructor are.

template <class T, class... Types>
concept OneOf = (std::same_as<T, Types> || ...);

/// The last enumerator of an enumeration that starts at 0 and has no gaps. It has no value for enumerations that are
/// missing below, so that code that reads them does not compile.
template <class E>
inline constexpr E kLastEnumerator;
template <>
inline constexpr auto kLastEnumerator<Glass::Formula> = Glass::Formula::table;
template <>
inline constexpr auto kLastEnumerator<CoatingKind> = CoatingKind::reflectance;
template <>
inline constexpr auto kLastEnumerator<SurfaceType> = SurfaceType::aperture;
template <>
inline constexpr auto kLastEnumerator<BaseForm> = BaseForm::toroid;
template <>
inline constexpr auto kLastEnumerator<ApertureOutline> = ApertureOutline::polygon;
/// Enumerations of two variants of sag terms, such as the two orders of Zernike terms; see kFormTerms.
template <class E>
    requires(is_form_variant<E>)
inline constexpr E kLastEnumerator<E> = E{1};
template <>
inline constexpr auto kLastEnumerator<RayStatus> = RayStatus::bad_input;
template <>
inline constexpr auto kLastEnumerator<CameraModel> = CameraModel::full_lens_double;
template <>
inline constexpr auto kLastEnumerator<CameraKeyInterpolation> = CameraKeyInterpolation::step;
template <>
inline constexpr auto kLastEnumerator<KeyInterpolation> = KeyInterpolation::cubic_spline;
template <>
inline constexpr auto kLastEnumerator<MaterialModel> = MaterialModel::metallic_roughness;
template <>
inline constexpr auto kLastEnumerator<FresnelTerm> = FresnelTerm::physical;
template <>
inline constexpr auto kLastEnumerator<TextureEncoding> = TextureEncoding::linear;
template <>
inline constexpr auto kLastEnumerator<TextureWrap> = TextureWrap::mirror;
template <>
inline constexpr auto kLastEnumerator<TextureFilter> = TextureFilter::nearest;

/// True if a type's strings are names or contents of files, which need not be UTF-8.
template <class T>
inline constexpr bool has_names_of_files = OneOf<T, Scene, Instance, SceneCamera, PythonMaterial>;

/// Throws InputError if a condition on unpickled data does not hold.
inline void require_restored(bool condition) {
    if (!condition) throw InputError("it is damaged");
}

template <class E>
constexpr bool is_enumerator(std::int64_t number) {
    return number >= 0 && number <= static_cast<std::int64_t>(kLastEnumerator<E>);
}

/// Creates a glass through its public constructors. Throws InputError.
inline Glass glass_from_parts(Glass::Parts parts) {
    const auto made = [&] {
        if (parts.formula == Glass::Formula::table) return Glass::table(std::move(parts.points));
        if (parts.formula == Glass::Formula::cauchy) return Glass::cauchy(std::move(parts.coefficients));
        require_restored(parts.coefficients.size() % 2 == 0);
        std::vector<Glass::SellmeierTerm> terms;
        for (std::size_t i = 0; i + 1 < parts.coefficients.size(); i += 2)
            terms.push_back({parts.coefficients[i], parts.coefficients[i + 1]});
        return Glass::sellmeier(terms);
    };
    Glass glass = made();
    glass.label = std::move(parts.label);
    return glass;
}

/// Makes the checks of a type's constructor: validate(value), if the type has it. Throws a realcam::Error. Types
/// without it have no constraint on several members, or are checked with the value that contains them.
template <class T>
void check_made(const T& value) {
    if constexpr (std::same_as<T, LensSystem>)
        validate_with_film(value);
    else if constexpr (std::same_as<T, Assembly>)
        SceneChecks().check(value);
    else if constexpr (!std::same_as<T, Scene> && requires { validate(value); })  // an Assembly checks its Scenes
        validate(value);
}

/// Checks a value whose bytes were copied from a pickle. The bytes of a bool or enumerator must be checked before the
/// value is read: any other bit pattern would be undefined behaviour.
template <class T>
void check_copied(const T& value) {
    using namespace value_compare_detail;
    if constexpr (std::same_as<T, bool>) {
        unsigned char byte;
        std::memcpy(&byte, &value, 1);
        require_restored(byte <= 1);
    } else if constexpr (std::is_enum_v<T>) {
        std::underlying_type_t<T> number;
        std::memcpy(&number, &value, sizeof number);
        require_restored(is_enumerator<T>(number));
    } else if constexpr (std::is_arithmetic_v<T>) {
    } else if constexpr (is_range<T>) {
        for (const auto& item : value) check_copied(item);
    } else {
        std::apply([](const auto&... member) { (check_copied(member), ...); }, members(value));
        check_made(value);
    }
}

/// Returns the shape of a numpy array or DeviceArray. Throws InputError for another object.
inline std::vector<pybind11::ssize_t> shape_of(const pybind11::object& array) {
    namespace py = pybind11;
    require_restored(py::isinstance<py::array>(array) || py::isinstance<SharedDeviceArray>(array));
    return array.attr("shape").cast<std::vector<py::ssize_t>>();
}

/// Returns the length of an array's first dimension. Throws InputError if the object is not an array or has none.
inline pybind11::ssize_t length_of(const pybind11::object& array) {
    const std::vector<pybind11::ssize_t> shape = shape_of(array);
    require_restored(!shape.empty());
    return shape[0];
}

/// Throws InputError if one of the objects is not an array of this kind (numpy's character: f floats, c complex
/// numbers, i integers) and shape.
inline void check_arrays(char kind, const std::vector<pybind11::ssize_t>& shape,
                         std::initializer_list<pybind11::object> arrays) {
    for (const pybind11::object& array : arrays) {
        require_restored(shape_of(array) == shape);
        const pybind11::object type = array.attr("dtype");
        require_restored(pybind11::dtype::from_args(type).kind() == kind && type.attr("isnative").cast<bool>());
    }
}

}  // namespace realcam::bindings
