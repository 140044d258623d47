#pragma once
#include "ggx_albedo.hpp"
#include "loss_tables.hpp"

namespace REALCAM_NAMESPACE {

// Energy that a perfectly reflecting rough metal loses under a coat if the lower of the coat's two transmittances,
// towards the eye and towards the light, is applied (bsdf.hpp); from a table (tools/make_loss_tables.py) for a coat of
// weight 1. The loss is proportional to the weight.

namespace coat_loss_detail {

using ggx_albedo_detail::between;
using ggx_albedo_detail::read_table;
using ggx_albedo_detail::table_position;
using ggx_albedo_detail::TablePosition;

inline constexpr int kCoatLayers = REALCAM_COAT_LAYERS, kCoatRows = REALCAM_COAT_ROWS,
                     kCoatColumns = REALCAM_COAT_COLUMNS;

}  // namespace coat_loss_detail

/// Loss at the cosine of the angle between normal and direction of view.
REALCAM_HD inline float coat_loss(float cosine, float coat_alpha, float metal_alpha) {
    using namespace coat_loss_detail;
    static constexpr float kLoss[] = {REALCAM_COAT_LOSS};
    static_assert(sizeof kLoss == sizeof(float) * kCoatLayers * kCoatRows * kCoatColumns);
    const TablePosition layer = table_position(std::sqrt(coat_alpha), kCoatLayers),
                        row = table_position(std::sqrt(metal_alpha), kCoatRows),
                        column = table_position(std::sqrt(cosine), kCoatColumns);
    const float* upper = kLoss + layer.index * kCoatRows * kCoatColumns;
    return between(read_table(upper, row, column, kCoatColumns),
                   read_table(upper + kCoatRows * kCoatColumns, row, column, kCoatColumns), layer.fraction);
}

/// Cosine-weighted mean of coat_loss over the hemisphere.
REALCAM_HD inline float coat_mean_loss(float coat_alpha, float metal_alpha) {
    using namespace coat_loss_detail;
    static constexpr float kLoss[] = {REALCAM_COAT_MEAN_LOSS};
    static_assert(sizeof kLoss == sizeof(float) * kCoatLayers * kCoatRows);
    return read_table(kLoss, table_position(std::sqrt(coat_alpha), kCoatLayers),
                      table_position(std::sqrt(metal_alpha), kCoatRows), kCoatRows);
}

}  // namespace REALCAM_NAMESPACE
