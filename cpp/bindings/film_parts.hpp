#pragma once
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../camera/film_region.hpp"
#include "../render/collected_film.hpp"
#include "arrays.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

/// Column and row of a region's first pixel, its width and its height.
using RegionNumbers = std::array<int, 4>;

inline FilmRegion region_from(const RegionNumbers& region) {
    return {region[0], region[1], region[2], region[3]};
}

/// What a region has collected, as a dict of an array (height, width) with the fields of PixelSum, and of its stats.
py::dict region_sums_to(RegionSums sums, const FilmRegion& region);

/// An array (height, width) with the fields of LayerSum.
py::array layer_sums_to(std::vector<LayerSum> sums, const FilmRegion& region);

/// Each as a dict: light (a number), sums (films, height, width, 3) int64, blocks and units_per_lux.
py::list splats_to(std::vector<SplatFilm> films);

/// Numbers of a picture's cost, under their names in Python.
using StatNumbers = std::map<std::string, double>;

RenderStats stats_from(const StatNumbers& numbers);

/// Numbers in Python that a film was collected as: see the functions above. Throws InputError where shapes differ.
struct FilmArrays {
    InputArray<PixelSum> pixels;
    std::optional<InputArray<LayerSum>> layers;
    py::list splats;

    CollectedFilm film() const;
};

}  // namespace realcam::bindings
