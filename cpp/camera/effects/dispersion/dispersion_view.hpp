#pragma once
#include <cstddef>
#include <cstdint>

#include "../../../math/color.hpp"
#include "../../../math/lanes.hpp"
#include "../../../optics/trace/index_cubic.hpp"
#include "../../../optics/trace/lens_view.hpp"
#include "../../../platform.hpp"

namespace REALCAM_NAMESPACE {

// Wavelengths of a picture's samples: the cells of the spectrum, and the pixels in which a sample counts.

/// A rectangle of the film, in pixels from the upper left corner of the picture.
struct FilmRegion {
    int column = 0, row = 0, width = 0, height = 0;

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

    /// Row-major index in the region of a pixel of the film.
    std::size_t index(int film_column, int film_row) const {
        return static_cast<std::size_t>(film_row - row) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(film_column - column);
    }
};

/// Pixels other than its own in which a sample may count (dispersed_rays.hpp): those of its tile in a part of the film.
/// Threads render whole tiles, so all these pixels have the same number of samples.
struct SampleSharing {
    static constexpr int kTileSide = 32;

    FilmRegion part;  ///< empty: samples count in their own pixel only
    int stride = 0;  ///< from a pixel to the one below, in the accumulated film

    /// True if two pixels of the film lie in the same tile. The first one must lie in `part`.
    REALCAM_INLINE bool has_both(int column, int row, int other_column, int other_row) const {
        const int right = other_column - part.column, down = other_row - part.row;
        const bool is_inside = (right >= 0) & (right < part.width) & (down >= 0) & (down < part.height);
        return is_inside & (right / kTileSide == (column - part.column) / kTileSide) &
               (down / kTileSide == (row - part.row) / kTileSide);
    }
};

/// Wavelengths per path (hero wavelength sampling): the sampled one, and others at uniform steps through the cells.
inline constexpr int kSharedWavelengths = 3;

/// Range of wavelengths. All cells are sampled with the same probability.
struct WavelengthCell {
    float first_nm, last_nm;
    float film[9];  ///< matrix from scene colour to film colour, 3 x 3, row-major; without a filter, its mean over
                    ///< all cells shows white as white
};

/// Wavelengths of a picture. Without dispersion, cell_count is 0.
struct DispersionView {
    const WavelengthCell* cells;
    int cell_count;  ///< a multiple of kSharedWavelengths, or 1
    WavelengthVariable variable;
    const IndexCubic *to_scene, *to_film;  ///< for each of the lens's surfaces, in the order in which light meets them
    const SurfaceView<float>* film_surfaces;  ///< the lens's surfaces for light towards the film
    AsymmetricParts<float> film_free;  ///< data of film_surfaces for LensKind::any
    SampleSharing sharing{};
    float film[9]{};  ///< mean of the cells' matrices
    float white_scale[3] = {1, 1, 1};  ///< inverse of the film colour of white through the filter; 0 if it is dark
};

/// SampleWavelengths::shares of a sample that counts for all wavelengths alike, in its own pixel.
inline constexpr std::int32_t kAllWavelengths = 1 << kSharedWavelengths;

/// Wavelengths for which samples count: the sampled one, at position `cell_position` in the list of cells, and others
/// at steps from it.
template <int N>
struct SampleWavelengths {
    Lanes<float, N> nm, cell_position;
    Lanes<std::int32_t, N> shares;  ///< bit mask of the steps that count, including step 0; or kAllWavelengths
    Lanes<std::int32_t, N> away[kSharedWavelengths - 1];  ///< offset in the film from its own pixel to that of each
                                                          ///< further step
    Lanes<float, N> passed[kSharedWavelengths];  ///< transmittance of a coated lens at each step
};

/// Wavelength at a position in the list of cells. Wavelengths are uniform within a cell.
REALCAM_INLINE float wavelength_at(const DispersionView& view, float cell_position) {
    const auto cell = static_cast<std::int32_t>(cell_position);
    const float share = cell_position - static_cast<float>(cell);
    const WavelengthCell& in = view.cells[cell];
    return in.first_nm + share * (in.last_nm - in.first_nm);
}

/// Position `step` steps of a third of the list further in the list of cells, wrapping around from the last cell to the
/// first.
REALCAM_INLINE float shared_cell_position(const DispersionView& view, float cell_position, int step) {
    const auto cells = static_cast<float>(view.cell_count);
    const float at = cell_position + static_cast<float>(step * (view.cell_count / kSharedWavelengths));
    return at < cells ? at : at - cells;
}

/// Film colour of light with a scene colour. `m`: matrix from scene to film colour, row-major.
REALCAM_INLINE Color film_color(const float (&m)[9], Color scene) {
    return {m[0] * scene.r + m[1] * scene.g + m[2] * scene.b, m[3] * scene.r + m[4] * scene.g + m[5] * scene.b,
            m[6] * scene.r + m[7] * scene.g + m[8] * scene.b};
}
/// Film colour of light with the wavelengths of the cell at a position.
REALCAM_INLINE Color film_color(const DispersionView& view, float cell_position, Color scene) {
    return film_color(view.cells[static_cast<std::int32_t>(cell_position)].film, scene);
}

}  // namespace REALCAM_NAMESPACE
