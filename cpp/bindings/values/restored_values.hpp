#pragma once
#include <cmath>
#include <numbers>

#include "../../camera/film/camera.hpp"
#include "../../camera/sensor/sensor.hpp"
#include "../../optics/lens/parabasal.hpp"
#include "../../optics/lens/paraxial.hpp"
#include "../../optics/prescription/coating_checks.hpp"
#include "../../optics/prescription/form_checks.hpp"
#include "../../optics/prescription/lens_checks.hpp"
#include "../../render/film/image.hpp"
#include "../../scene/scene_checks.hpp"
#include "material.hpp"
#include "restored.hpp"

namespace realcam::bindings {

// Checks of unpickled values of the core. Results of calculations are checked in the files that bind them.

template <class T>
struct RestoredCheck<Vec2<T>> : AnyMembers {};
template <class T>
struct RestoredCheck<Vec3<T>> : AnyMembers {};
template <class T>
struct RestoredCheck<Affine<T>> : AnyMembers {};

/// Parts that are checked together with the value that contains them: a glass's parts by restored_glass, layers and
/// metal by the coating, whose error names the layer, and a material by the scene.
template <OneOf<Color, Glass::TablePoint, Glass::Parts, CoatingMaterial::Point, CoatingMaterial, SurfacePlacement,
                XyTerm, SurfaceForm, Obscuration, ApertureShape, IrisShape, FocusingRule, ZoomPosition, ZoomRange,
                FirstOrder, Meridian, Pose, PoseKey, Shutter, QuantumEfficiency, SensorPoint, SensorConversion,
                SensorNoise, RenderStats, Triangle, VertexColor, TextureSampler, TextureReference, Material,
                ScenePointLight, SunLight, Environment, Scene, Instance>
              T>
struct RestoredCheck<T> : AnyMembers {};

// Types of a lens.

template <>
struct LastEnumerator<Glass::Formula> : LastIs<Glass::Formula::table> {};
template <>
struct LastEnumerator<CoatingKind> : LastIs<CoatingKind::reflectance> {};
template <>
struct LastEnumerator<SurfaceType> : LastIs<SurfaceType::aperture> {};

/// Creates a glass through the public constructors. Throws InputError.
inline Glass restored_glass(Glass::Parts parts) {
    const auto made = [&] {
        if (parts.formula == Glass::Formula::table) return Glass::table(std::move(parts.points));
        if (parts.formula == Glass::Formula::cauchy) return Glass::cauchy(std::move(parts.coefficients));
        require_restored(parts.coefficients.size() % 2 == 0);
        std::vector<Glass::SellmeierTerm> terms;
        for (std::size_t i = 0; i + 1 < parts.coefficients.size(); i += 2)
            terms.push_back({parts.coefficients[i], parts.coefficients[i + 1]});
        return Glass::sellmeier(terms);
    };
    require_restored(parts.formula == Glass::Formula::table ? parts.coefficients.empty() : parts.points.empty());
    Glass glass = made();
    glass.label = std::move(parts.label);
    return glass;
}

template <>
struct RestoredCheck<CoatingLayer> {
    static void check(const CoatingLayer& layer) { check_coating(layered_coating({layer})); }
};
template <>
struct RestoredCheck<Coating> {
    static void check(const Coating& coating) {
        // Checks the metal even if the coating's kind does not use it, because code that evaluates a material's index
        // relies on valid points.
        check_coating(metal_mirror(coating.metal));
        check_coating(coating);
    }
};
template <>
struct LastEnumerator<BaseForm> : LastIs<BaseForm::toroid> {};
/// Enumerations of two variants of sag terms, such as the two orders of Zernike terms; see kFormTerms.
template <class E>
    requires(is_form_variant<E>)
struct LastEnumerator<E> : LastIs<E{1}> {};
template <>
struct LastEnumerator<ApertureOutline> : LastIs<ApertureOutline::polygon> {};

template <class Terms>
    requires requires { Terms::words; }
struct RestoredCheck<Terms> : AnyMembers {};
template <>
struct RestoredCheck<Surface> {
    /// Checks that do not depend on the lens.
    static void check(const Surface& surface) {
        if (!std::isfinite(surface.curvature)) throw InputError("a surface's radius of curvature must not be 0");
        if (surface.aspheric.size() > static_cast<std::size_t>(kMaxAsphericTerms))
            throw InputError("a surface has more aspheric coefficients than " + std::to_string(kMaxAsphericTerms));
        if (const std::string why = form_error(surface); !why.empty()) throw InputError("a surface " + why);
    }
};
template <>
struct RestoredCheck<LensSystem> {
    static void check(const LensSystem& lens) {
        // Checked first, because refractive indices are evaluated at this wavelength, and messages print it as an
        // integer.
        if (!(lens.wavelength_nm >= 100 && lens.wavelength_nm <= 20000))
            throw LensFileError("the design wavelength must lie between 100 and 20000 nm");
        validate(lens);
        if (const std::string why = film_distance_error(lens); !why.empty()) throw LensFileError(why);
        if (!(lens.stop_semi_diameter >= 0 && lens.stop_semi_diameter <= kLongest))
            throw LensFileError("the radius of the lens's open stop must be a length of 0 or more");
        if (std::isnan(lens.focus_distance)) throw LensFileError("the focus distance must be a number");
        if (!(lens.focusing.nearest_mm >= 0)) throw LensFileError("the nearest focus distance must be 0 or more");
    }
};

// Types of a camera and its film, sensor and exposure.

template <>
struct LastEnumerator<CameraModel> : LastIs<CameraModel::full_lens_double> {};

template <OneOf<CalibratedGeometry::Mask, CalibratedGeometry::Inverse, CalibratedGeometry::Pinhole> T>
struct RestoredCheck<T> : AnyMembers {};
template <OneOf<Film, CalibratedGeometry, Camera, Sensor> T>
struct RestoredCheck<T> {
    static void check(const T& value) { validate(value); }
};

// Types of a scene.

template <>
struct LastEnumerator<MaterialModel> : LastIs<MaterialModel::metallic_roughness> {};
template <>
struct LastEnumerator<FresnelTerm> : LastIs<FresnelTerm::physical> {};
template <>
struct LastEnumerator<TextureEncoding> : LastIs<TextureEncoding::linear> {};
template <>
struct LastEnumerator<TextureWrap> : LastIs<TextureWrap::mirror> {};
template <>
struct LastEnumerator<TextureFilter> : LastIs<TextureFilter::nearest> {};

template <>
inline constexpr bool has_names_of_files<Scene> = true;
template <>
inline constexpr bool has_names_of_files<Instance> = true;
template <>
inline constexpr bool has_names_of_files<SceneCamera> = true;
template <>
inline constexpr bool has_names_of_files<PythonMaterial> = true;

template <>
struct RestoredCheck<Texture> {
    static void check(const Texture& texture) {
        const std::size_t texels = static_cast<std::size_t>(std::max(texture.width, 0)) *
                                   static_cast<std::size_t>(std::max(texture.height, 0));
        const std::size_t numbers = texture.rgba.empty() ? texture.linear_rgba.size() : texture.rgba.size();
        if (texels == 0 || numbers != 4 * texels)
            throw InputError("a texture's number of values must be 4 times its width times its height");
        for (const float number : texture.linear_rgba)
            if (!(number >= 0) || !std::isfinite(number))
                throw InputError("a texture's values must be finite and not negative");
    }
};
template <>
struct RestoredCheck<Motion> {
    static void check(const Motion& motion) {
        if (const std::string why = motion_error(motion); !why.empty()) throw InputError(why);
    }
};
template <>
struct RestoredCheck<SceneCamera> {
    static void check(const SceneCamera& camera) {
        const Affine<double>& transform = camera.scene_from_camera;
        for (const Vec3d& column : {transform.x, transform.y, transform.z, transform.origin})
            require_restored(std::isfinite(column.x) && std::isfinite(column.y) && std::isfinite(column.z));
        require_restored(camera.vertical_field_rad >= 0 && camera.vertical_field_rad < std::numbers::pi);
    }
};
template <>
struct RestoredCheck<Assembly> {
    static void check(const Assembly& scene) {
        SceneChecks().check(scene);
        for (std::size_t i = 0; i < scene.instances.size(); ++i) {
            const std::ptrdiff_t whole = scene.instances[i].part_of;
            if (whole < Instance::kNoParentInstance || whole >= static_cast<std::ptrdiff_t>(i))
                throw InputError(label(scene, i) + " is a part of instance " + std::to_string(whole) +
                                 "; expected an instance before it in the list");
        }
    }
};
template <>
struct RestoredCheck<PythonMaterial> {
    /// Other values are checked together with the scene that receives the material.
    static void check(const PythonMaterial& material) {
        for (const auto member : kMaterialTextures)
            if ((material.values.*member).texture != -1)
                throw InputError("a material outside of a scene must not have texture indices");
    }
};

}  // namespace realcam::bindings
