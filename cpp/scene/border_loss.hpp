#pragma once
#include "ggx_albedo.hpp"
#include "loss_tables.hpp"

namespace REALCAM_NAMESPACE {

// Energy that single scattering (one reflection or transmission by a microfacet) loses at a rough dielectric interface,
// from tables (tools/make_loss_tables.py). `critical` is the cosine of the critical angle; it stands for the ratio of
// the two refractive indices.

enum class BorderSide : int { outside, inside };  ///< the side of the lower and of the higher refractive index

/// Lowest refractive index of the tables: that of the smallest tabulated cosine of the critical angle.
inline constexpr float kLeastRoughIndex = 1.0482848f;

namespace border_loss_detail {

using ggx_albedo_detail::between;
using ggx_albedo_detail::read_table;
using ggx_albedo_detail::row_of;
using ggx_albedo_detail::table_position;
using ggx_albedo_detail::TablePosition;

inline constexpr int kBorderLayers = REALCAM_BORDER_LAYERS, kBorderRows = REALCAM_BORDER_ROWS,
                     kBorderColumns = REALCAM_BORDER_COLUMNS, kBorderMeanRows = REALCAM_BORDER_MEAN_ROWS;

REALCAM_INLINE TablePosition layer_of(float critical) {
    constexpr float kLeast = REALCAM_BORDER_LEAST_CRITICAL, kMost = REALCAM_BORDER_MOST_CRITICAL;
    return table_position((critical - kLeast) / (kMost - kLeast), kBorderLayers);
}

}  // namespace border_loss_detail

/// Loss (1 - directional albedo) of single scattering at the cosine of the angle of incidence. `found`: the directional
/// albedo of perfectly reflecting facets with single scattering, ggx_albedo(cosine, alpha).all.
REALCAM_HD inline float border_loss(BorderSide side, float cosine, float alpha, float critical, float found) {
    using namespace border_loss_detail;
    static constexpr float kLoss[] = {REALCAM_BORDER_LOSS};
    static_assert(sizeof kLoss == sizeof(float) * 2 * kBorderLayers * kBorderRows * kBorderColumns);
    const TablePosition layer = layer_of(critical), row = row_of(alpha, kBorderRows),
                        column = table_position(std::sqrt(cosine), kBorderColumns);
    const float* upper = kLoss + (static_cast<int>(side) * kBorderLayers + layer.index) * kBorderRows * kBorderColumns;
    const float factor =
        between(read_table(upper, row, column, kBorderColumns),
                read_table(upper + kBorderRows * kBorderColumns, row, column, kBorderColumns), layer.fraction);
    const float loss = factor * (1.0f - found + 0.5f * alpha);
    return loss < 1.0f ? loss : 1.0f;
}

/// Cosine-weighted mean of border_loss over the hemisphere.
REALCAM_HD inline float border_mean_loss(BorderSide side, float alpha, float critical) {
    using namespace border_loss_detail;
    static constexpr float kLoss[] = {REALCAM_BORDER_MEAN_LOSS};  // divided by alpha^2
    static_assert(sizeof kLoss == sizeof(float) * 2 * kBorderLayers * kBorderMeanRows);
    const float* table = kLoss + static_cast<int>(side) * kBorderLayers * kBorderMeanRows;
    return alpha * alpha * read_table(table, layer_of(critical), row_of(alpha, kBorderMeanRows), kBorderMeanRows);
}

}  // namespace REALCAM_NAMESPACE
