#include "pupil_entries.hpp"

namespace realcam {
namespace {

std::vector<FoundRay> rays_of(const PupilView& pupil, const LensView<float>& lens, double film_radius,
                              double film_distance, const PupilTracer& tracer) {
    constexpr int kBlock = PupilTracer::kBlock, kSide = 8, kPerRing = kSide * kSide, kRings = kGhostBins;
    constexpr int kBlocks = kRings * kPerRing / kBlock;
    static_assert(kBlocks * kBlock == kRings * kPerRing);
    std::vector<PupilTracer::Rays> blocks(kBlocks);
    tracer.for_each(kBlocks, [&](int block) {
        PupilTracer::Rays& rays = blocks[static_cast<std::size_t>(block)];
        for (int k = 0; k < kBlock; ++k) {
            const int ring = (block * kBlock + k) / kPerRing, index = (block * kBlock + k) % kPerRing;
            const float radius = static_cast<float>(film_radius) * (static_cast<float>(ring) + 0.5f) / kRings;
            const PupilSample sample =
                sample_pupil(pupil, radius, 0, (static_cast<float>(index % kSide) + 0.5f) / kSide,
                             (static_cast<float>(index / kSide) + 0.5f) / kSide);
            rays.origin.set(k, {radius, 0, static_cast<float>(film_distance)});
            rays.direction.set(k, sample.direction);
            rays.status[k] = sample.weight > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
        }
        tracer.trace(lens, rays);
    });
    std::vector<FoundRay> found;
    for (const PupilTracer::Rays& rays : blocks)
        for (int k = 0; k < kBlock; ++k) {
            if (rays.status[k] != 0) continue;
            FoundRay ray{};
            FilmRings::set_front(rays.origin[k], normalized(rays.direction[k]), ray);
            found.push_back(ray);
        }
    return found;
}

}  // namespace

PupilEntries::PupilEntries(const PupilView& pupil, const LensView<float>& lens, double film_radius,
                           double film_distance, const PupilTracer& tracer) {
    const std::vector<FoundRay> found = rays_of(pupil, lens, film_radius, film_distance, tracer);
    directions_ = FilmRings::directions_of({found});
    entries_ = entries_of<FilmRings>(found, directions_);
}

}  // namespace realcam
