// Conversions between accumulated samples of the core and Python arrays.

#pragma once
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../../camera/effects/dispersion/dispersion_view.hpp"
#include "../../render/film/film_sums.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

/// Column and row of a region's first pixel, its width and its height.
using RegionNumbers = std::array<int, 4>;

inline FilmRegion region_from(const RegionNumbers& region) {
    return {region[0], region[1], region[2], region[3]};
}

/// Dict with the sums of a region, see region_sums_to.
using RegionSumArrays = Typed<"_RegionSums", py::dict>;
/// Structured array.
using VoidArray = Typed<"NDArray[void]", py::array>;
/// List of films of splats, see splats_to. Splats are light that is traced from the lights, or by ghosts, to any pixel.
using SplatList = Typed<"list[_Splats]", py::list>;

/// Converts the sums of a region to a dict: "pixels", an array (height, width) with the fields of PixelSum; "stats",
/// see StatNumbers.
RegionSumArrays region_sums_to(RegionSums sums, const FilmRegion& region);

/// Converts the layer sums of a region to an array (height, width) with the fields of LayerSum.
VoidArray layer_sums_to(std::vector<LayerSum> sums, const FilmRegion& region);

/// Converts each film to a dict with the members of SplatFilm: light (int), sums (films, height, width, 3) int64,
/// blocks and units_per_lux.
SplatList splats_to(std::vector<SplatFilm> films);

/// Rendering statistics by the names of the members of RenderStats.
using StatNumbers = std::map<std::string, double>;

/// Throws std::out_of_range if a name is missing.
RenderStats stats_from(const StatNumbers& numbers);

/// Accumulated film as Python arrays, in the formats of the functions above.
struct FilmArrays {
    InputArray<PixelSum> pixels;
    std::optional<InputArray<LayerSum>> layers;
    SplatList splats;

    /// Converts the arrays. Throws InputError for invalid shapes.
    AccumulatedFilm film() const;
};

}  // namespace realcam::bindings
