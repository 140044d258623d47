#pragma once
#include <cstdint>

#include "../math/color.hpp"
#include "../math/lanes.hpp"
#include "../optics/trace/index_cubic.hpp"
#include "../optics/trace/lens_view.hpp"
#include "sample_sharing.hpp"

namespace REALCAM_NAMESPACE {

/// How many wavelengths a ray through the scene may count for: its own, and others at even steps through the cells.
inline constexpr int kSharedWavelengths = 3;

/// A range of wavelengths. All cells are drawn with the same probability.
struct WavelengthCell {
    float first_nm, last_nm;
    float film[9];  ///< scene colour to film colour, 3 x 3, row by row; the mean over all cells is the identity
};

/// The wavelengths of a picture. Without dispersion there are no cells.
struct DispersionView {
    const WavelengthCell* cells;
    int cell_count;  ///< a multiple of kSharedWavelengths, or 1
    WavelengthVariable variable;
    const IndexCubic *to_scene, *to_film;  ///< of the lens's surfaces, in the order in which light meets them
    const SurfaceView<float>* film_surfaces;  ///< of the lens, on the light's way to the film
    FreeParts<float> film_free;               ///< and what belongs to them
    SampleSharing sharing{};
    float film[9]{};  ///< as that of a cell: their mean, by which white stays white
};

/// The shares of a sample that counts for all wavelengths alike, in its own pixel.
inline constexpr std::int32_t kAllWavelengths = 1 << kSharedWavelengths;

/// Wavelengths for which samples count: one that was drawn, and others at steps from its place.
template <int N>
struct SampleWavelengths {
    Lanes<float, N> nm, place;
    Lanes<std::int32_t, N> shares;  ///< a bit for each step that counts, and the first of them; or kAllWavelengths
    Lanes<std::int32_t, N> away[kSharedWavelengths - 1];  ///< from its own pixel to that in which a further one counts
    Lanes<float, N> passed[kSharedWavelengths];  ///< by a coated lens, at each step
};

/// Wavelengths are drawn evenly over the cells: this one is the same share of its cell as the place's.
REALCAM_INLINE float wavelength_at(const DispersionView& view, float place) {
    const auto cell = static_cast<std::int32_t>(place);
    const float share = place - static_cast<float>(cell);
    const WavelengthCell& in = view.cells[cell];
    return in.first_nm + share * (in.last_nm - in.first_nm);
}

/// `step` steps further from a place, and from the last cell on to the first.
REALCAM_INLINE float shared_place(const DispersionView& view, float place, int step) {
    const auto cells = static_cast<float>(view.cell_count);
    const float at = place + static_cast<float>(step * (view.cell_count / kSharedWavelengths));
    return at < cells ? at : at - cells;
}

/// The film's colour for light of a scene's colour. `m`: from one to the other, row by row.
REALCAM_INLINE Color film_color(const float (&m)[9], Color scene) {
    return {m[0] * scene.r + m[1] * scene.g + m[2] * scene.b, m[3] * scene.r + m[4] * scene.g + m[5] * scene.b,
            m[6] * scene.r + m[7] * scene.g + m[8] * scene.b};
}
/// The same for light that has the wavelengths of a place's cell.
REALCAM_INLINE Color film_color(const DispersionView& view, float place, Color scene) {
    return film_color(view.cells[static_cast<std::int32_t>(place)].film, scene);
}

}  // namespace REALCAM_NAMESPACE
