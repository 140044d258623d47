#include "copy_path.hpp"

namespace realcam {

CopyPath::CopyPath(const LensSystem& lens, const std::vector<double>& wavelengths_nm)
    : first_(lens, LightDirection::to_film, wavelengths_nm.front()) {
    const std::vector<Crossing> crossings = crossings_of(lens);
    const LensView<double> view = first_.view();
    for (const double wavelength : wavelengths_nm) {
        const std::vector<double> indices = lens.indices(wavelength);
        std::vector<SurfaceView<double>>& surfaces = surfaces_.emplace_back(view.surfaces, view.surfaces + view.count);
        for (std::size_t k = 0; k < surfaces.size(); ++k) {
            const double before = crossings[k].index_before(indices), behind = crossings[k].index_behind(indices);
            surfaces[k].index_squared = before * before;
            surfaces[k].squared_index_change = (behind - before) * (behind + before) / (before * before);
        }
        entry_indices_.push_back(indices.front());
    }
}

CopyPath::At CopyPath::at(std::size_t wavelength) const {
    LensView<double> view = first_.view();
    view.surfaces = surfaces_[wavelength].data();
    return {view, first_.entry_position, entry_indices_[wavelength]};
}

}  // namespace realcam
