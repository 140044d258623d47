// Finding the pupil, on any threads.

#include <atomic>
#include <cstring>
#include <thread>
#include <vector>

#include "../../cpp/embree/embree_backend.hpp"
#include "about.hpp"
#include "doctest/doctest.h"
#include "pupil_region.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

template <class T>
bool same_bits(const T* a, const T* b, int count) {
    return std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(T)) == 0;
}

bool same_pupil(const PupilView& a, const PupilView& b) {
    return same_bits(a.nodes, b.nodes, a.rows + 1) && same_bits(a.outline, b.outline, a.rows * a.sectors) &&
           same_bits(&a.image_radius, &b.image_radius, 1);
}

/// Takes its tasks from the last to the first.
void backwards(int count, const PupilTracer::Task& task) {
    for (int i = count - 1; i >= 0; --i) task(i);
}

void on_five_threads(int count, const PupilTracer::Task& task) {
    std::atomic<int> next{0};
    std::vector<std::thread> threads;
    for (int k = 0; k < 5; ++k)
        threads.emplace_back([&] {
            for (int i = next++; i < count; i = next++) task(i);
        });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace

TEST_CASE("the pupil is the same bits on one thread and on many, in any order") {
    const PupilTracer fast = fast_pupil_tracer();
    // Whole images and ones that end inside the film, holes, aspheres, and rows that change.
    for (const char* name : {"double-gauss-50mm", "fisheye-6mm-220deg", "mirror-telephoto-500mm", "phone-4mm"})
        for (const double f_number : {0.0, 11.0}) {
            LensSystem lens = io::read_lens(name);
            if (f_number > 0) lens = stopped_down(lens, f_number);
            CAPTURE(lens.name);
            CAPTURE(f_number);
            const Pupil alone(lens, half_diagonal(lens), {fast.trace});
            const Pupil on_all_cores(lens, half_diagonal(lens), fast);
            const Pupil reversed(lens, half_diagonal(lens), {fast.trace, backwards});
            const Pupil on_five(lens, half_diagonal(lens), {fast.trace, on_five_threads});
            REQUIRE(alone.image_radius() > 0);
            CHECK(same_pupil(alone.view(), on_all_cores.view()));
            CHECK(same_pupil(alone.view(), reversed.view()));
            CHECK(same_pupil(alone.view(), on_five.view()));
        }
}
