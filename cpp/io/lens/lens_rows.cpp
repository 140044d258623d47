#include "lens_rows.hpp"

namespace realcam::io {

std::vector<KeptRow> kept_rows(const Prescription& p) {
    std::vector<KeptRow> kept;
    const Glass air = Glass::air();
    const Glass* before = &air;
    for (std::size_t i = 0; i < p.surfaces.size(); ++i) {
        const PrescriptionSurface& row = p.surfaces[i];
        const bool bends = row.is_mirror || !(row.material == *before);
        if (row.is_stop) kept.push_back({i, SurfaceType::stop});
        if (bends)
            kept.push_back({i, row.is_mirror ? SurfaceType::mirror : SurfaceType::refracting});
        else if (!row.is_stop && row.blocks)
            kept.push_back({i, SurfaceType::aperture});
        if (!row.is_mirror) before = &row.material;
    }
    return kept;
}

}  // namespace realcam::io
