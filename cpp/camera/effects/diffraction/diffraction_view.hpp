#pragma once
#include <cstdint>

#include "../../../math/cdf.hpp"
#include "../../../math/sincos.hpp"
#include "../../../optics/pupil/diffraction_cells.hpp"

namespace REALCAM_NAMESPACE {

/// Largest number of edge segments of an aperture.
inline constexpr int kDiffractionEdges = 320;
/// Alias-table entries of a node: first those of the edges, then those of the cells.
inline constexpr int kDiffractionEntries = kDiffractionEdges + kDiffractionCells;

// Diffraction pattern of a lens's aperture as a density of offsets on the film (kicks), for random sampling. Close to
// the geometric image, the pattern is tabulated in cells of spatial frequency; farther away, it is sampled from the
// straight segments of the aperture's edge. Frequencies are in periods over the aperture's width, 1 turn is a full
// circle.

/// Diffraction by the lens's aperture as seen from one film point.
struct DiffractionNode {
    float mm_per_nm;  ///< offset on the film for one period over the aperture's width, per nm of wavelength
    float edge_share;  ///< fraction of the light that is diffracted beyond the cells
};

/// Diffraction of a lens at film points of uniformly spaced radii and, if blades make it depend on them, azimuths.
/// Without diffraction, `radii` is 0.
struct DiffractionView {
    const DiffractionNode* nodes;  ///< radii x azimuths
    const AliasEntry* entries;     ///< kDiffractionEntries for each node
    const DiffractionEdge* edges;  ///< kDiffractionEdges for each node
    int radii;  ///< number of film radii
    int azimuths;  ///< number of azimuths; 1: the diffraction pattern rotates with the film point's azimuth
    float radii_per_mm;  ///< nodes per mm of film radius
    float largest_radius;  ///< largest film radius, mm
    float splat_density;  ///< density of edge-diffracted pixel samples per splat of a light, for MIS weights, per
                          ///< steradian
};

/// Number of pixel samples for each splat of a light.
inline constexpr int kSamplesPerSplat = 32;

namespace diffraction_detail {

/// Index of a node for a film point, mm: one of its neighbours, chosen with its interpolation weight as probability.
/// `u`, `v`: random numbers in [0, 1) that select the radius and the azimuth.
REALCAM_INLINE std::int32_t node_at(const DiffractionView& view, Vec2f film, float u, float v) {
    const float radius = sqrt_or_zero(film.x * film.x + film.y * film.y);
    const auto ring = static_cast<std::int32_t>(radius * view.radii_per_mm + u);
    const std::int32_t row = select(ring < view.radii, ring, view.radii - 1);
    // Azimuth parameter from 0 to 4, along a square instead of a circle.
    const float around = std::fabs(film.x) + std::fabs(film.y);
    const float y = quotient(film.y, select(around > 0.0f, around, 1.0f));
    const float angle = select(film.x < 0.0f, 2.0f - y, select(y < 0.0f, 4.0f + y, y));
    const auto sector = static_cast<std::int32_t>(0.25f * static_cast<float>(view.azimuths) * angle + v);
    return row * view.azimuths + select(sector < view.azimuths, sector, 0);
}

/// Random frequency along a straight edge, in periods over its length, with density sinc^2: a fit to the inverse
/// cumulative distribution, accurate to 3% and exact in the tails. The tails reach across the film and fall only as 1 /
/// f, so u needs all its bits: its largest values give one frequency, which would show as an image.
REALCAM_INLINE float frequency_along_edge(float u) {
    const float fraction = std::fabs(2.0f * u - 1.0f);  // of the light within this frequency
    const float size = fraction * (0.5f + fraction * (-0.34473f + fraction * (-0.44109f + fraction * 0.38714f)));
    const float frequency = quotient(size, select(fraction < 1.0f, 1.0f - fraction, 0x1p-24f));
    return select(u < 0.5f, -frequency, frequency);
}

/// Remaining bits of a random number as a number in [0, 1), after the leading log2(scale) bits have been used.
REALCAM_INLINE float remaining_bits(float u, float scale) {
    const float scaled = scale * u;
    return scaled - static_cast<float>(static_cast<std::int32_t>(scaled));
}

/// Random number for the frequency along an edge: eight bits that node_at does not use, and lower bits that hardly
/// affect the position on an edge segment.
REALCAM_INLINE float number_along_edge(Vec2f u, Vec2f v) {
    return remaining_bits(u.y, 0x1p16f) + 0x1p-8f * remaining_bits(v.y, 0x1p9f);
}

/// Square of the inner frequency of a ring of cells; rings are thin near the centre and kDiffractionMergedRings times
/// as wide beyond.
REALCAM_INLINE float ring_edge_squared(std::int32_t ring) {
    const std::int32_t beyond = ring - kDiffractionUnmergedRings;
    const float f =
        kDiffractionFineStep * static_cast<float>(ring + select(beyond > 0, (kDiffractionMergedRings - 1) * beyond, 0));
    return f * f;
}

/// Random frequency in a cell, in periods over the aperture's width. `u`: random numbers in [0, 1).
REALCAM_INLINE Vec2f cell_frequency(std::int32_t cell, Vec2f u) {
    const std::int32_t ring = cell / kDiffractionAzimuths, azimuth = cell - ring * kDiffractionAzimuths;
    const float low = ring_edge_squared(ring), high = ring_edge_squared(ring + 1);
    const float f = sqrt_or_zero(low + u.x * (high - low));
    const Vec2f direction =
        cos_sin_of_turn((static_cast<float>(azimuth) + u.y) * static_cast<float>(0.5 / kDiffractionAzimuths));
    return {f * direction.x, f * direction.y};
}

/// Random frequency of an edge segment. `f`: component along the edge's normal; `position`: position on the segment, 0
/// to 1; `u`: random number for the component along the edge.
REALCAM_INLINE Vec2f edge_frequency(const DiffractionEdge& edge, float f, float position, float u) {
    const float turns = edge.angle + position * edge.turn;
    const Vec2f normal = cos_sin_of_turn(turns - select(turns >= 1.0f, 1.0f, select(turns < 0.0f, -1.0f, 0.0f)));
    const float along = edge.spread * frequency_along_edge(u);
    return {f * normal.x - along * normal.y, f * normal.y + along * normal.x};
}

/// Rotates a vector to the film point's azimuth if the nodes have a single azimuth.
REALCAM_INLINE Vec2f rotated_to_azimuth(Vec2f film, int azimuths, Vec2f v) {
    const float squared = film.x * film.x + film.y * film.y;
    const bool rotates = (azimuths == 1) & (squared > 0.0f);
    const float inverse = quotient(1.0f, sqrt_or_zero(select(rotates, squared, 1.0f)));
    const float x = select(rotates, film.x * inverse, 1.0f), y = select(rotates, film.y * inverse, 0.0f);
    return {x * v.x - y * v.y, y * v.x + x * v.y};
}

}  // namespace diffraction_detail

/// Offset of light on the film by diffraction.
struct DiffractionKick {
    Vec2f mm_per_nm;  ///< per nm of wavelength
    std::int32_t from_edge;  ///< 1: beyond the range of the cells
};

/// Samples a kick for the light of a film point, mm. The density is the power that the aperture diffracts there. `u`,
/// `v`: random numbers in [0, 1), whose bits are used for several choices.
REALCAM_INLINE DiffractionKick draw_kick(const DiffractionView& view, Vec2f film, Vec2f u, Vec2f v) {
    using namespace diffraction_detail;
    const std::int32_t at = node_at(view, film, u.y, remaining_bits(u.y, 0x1p8f));
    const DiffractionNode& node = view.nodes[at];
    const bool is_edge = u.x < node.edge_share;
    const float rescaled =
        select(is_edge, u.x, u.x - node.edge_share) / select(is_edge, node.edge_share, 1.0f - node.edge_share);
    const std::int32_t drawn =
        draw_entry(view.entries, at * kDiffractionEntries + select(is_edge, 0, kDiffractionEdges),
                   select(is_edge, kDiffractionEdges, kDiffractionCells), rescaled);
    const float side = select(v.y < 0.5f, 1.0f, -1.0f), position = remaining_bits(v.y, 2.0f);
    const Vec2f in_cell = cell_frequency(select(is_edge, 0, drawn), {v.x, position});
    const Vec2f from_edge =
        edge_frequency(view.edges[at * kDiffractionEdges + select(is_edge, drawn, 0)],
                       quotient(kDiffractionMaxFrequency, 1.0f - v.x), position, number_along_edge(u, v));
    const float scale = side * node.mm_per_nm;
    const Vec2f kick = {scale * select(is_edge, from_edge.x, in_cell.x),
                        scale * select(is_edge, from_edge.y, in_cell.y)};
    return {rotated_to_azimuth(film, view.azimuths, kick), select(is_edge, 1, 0)};
}

/// Kick from an edge, log-uniformly distributed from the range of the cells to the whole film. It reaches the dark
/// areas between spikes more often than light does, with a smaller weight: with weight 1 it would make a bright speck
/// there.
struct EdgeKick {
    Vec2f mm_per_nm;
    float weight;  ///< density of the light over the sampling density
};

/// Samples an EdgeKick for light of the wavelength `nm` at a film point, mm. `u`, `v`: random numbers in [0, 1).
REALCAM_INLINE EdgeKick draw_edge_kick(const DiffractionView& view, Vec2f film, float nm, Vec2f u, Vec2f v) {
    using namespace diffraction_detail;
    const std::int32_t at = node_at(view, film, u.y, remaining_bits(u.y, 0x1p8f));
    const DiffractionNode& node = view.nodes[at];
    const std::int32_t edge = draw_entry(view.entries, at * kDiffractionEntries, kDiffractionEdges, u.x);
    const float largest = quotient(2.0f * view.largest_radius, node.mm_per_nm * nm);
    const float range = std::log(
        quotient(largest > kDiffractionMaxFrequency ? largest : kDiffractionMaxFrequency, kDiffractionMaxFrequency));
    const float ratio = std::exp(v.x * range);
    const float side = select(v.y < 0.5f, 1.0f, -1.0f), scale = side * node.mm_per_nm;
    // Squaring the distance to the nearer end makes small distances more frequent; the derivative is the weight.
    const float along = number_along_edge(u, v), left = 2.0f * select(along < 0.5f, along, 1.0f - along);
    const float tail = 0.5f * left * left;
    const Vec2f from_edge = edge_frequency(view.edges[at * kDiffractionEdges + edge], kDiffractionMaxFrequency * ratio,
                                           remaining_bits(v.y, 2.0f), select(along < 0.5f, tail, 1.0f - tail));
    return {rotated_to_azimuth(film, view.azimuths, {scale * from_edge.x, scale * from_edge.y}),
            2.0f * left * node.edge_share * range / ratio};
}

}  // namespace REALCAM_NAMESPACE
