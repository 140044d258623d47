#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "io/lens/lens_file.hpp"
#include "io/lens/lens_text.hpp"

namespace realcam {

/// Names of the bundled lenses that are centred, of revolution, and have a flat film: what closed forms and the
/// paraxial equations of a lens presume. test_unusual_lenses.py has the others.
inline const std::vector<std::string>& centred_lens_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const std::string& name : io::lens_names()) {
            const LensSystem lens = io::read_lens(name);
            if (lens.is_rotational() && std::isinf(lens.film_radius_of_curvature)) list.push_back(name);
        }
        return list;
    }();
    return names;
}

}  // namespace realcam
