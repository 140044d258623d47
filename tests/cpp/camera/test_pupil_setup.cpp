// Finding the pupil: on any threads, and not again for the same lens.

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "about.hpp"
#include "camera/camera_setup.hpp"
#include "doctest/doctest.h"
#include "embree/lens_rays.hpp"
#include "pixel_rays.hpp"
#include "pupil_region.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

template <class T>
bool same_bits(const T* a, const T* b, int count) {
    return std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(T)) == 0;
}

bool same_pupil(const PupilView& a, const PupilView& b) {
    return same_bits(a.nodes, b.nodes, a.rows + 1) && same_bits(a.outline, b.outline, a.rows * PupilView::kSectors) &&
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

/// Counts the blocks that it traces.
PupilTracer counting(std::atomic<int>& blocks) {
    return {[&blocks](const LensView<float>& view, PupilTracer::Rays& rays) {
        ++blocks;
        trace_lens(view, rays);
    }};
}

/// Blocks of rays, and those of them that cores enough would trace one after another.
struct Blocks {
    int all = 0, in_a_row = 0;

    PupilTracer tracer() {
        return {[this](const LensView<float>& view, PupilTracer::Rays& rays) {
                    ++all;
                    ++in_a_row;
                    trace_lens(view, rays);
                },
                [this](int count, const PupilTracer::Task& task) {
                    const int before = in_a_row;
                    int longest = before;
                    for (int i = 0; i < count; ++i) {
                        in_a_row = before;
                        task(i);
                        longest = std::max(longest, in_a_row);
                    }
                    in_a_row = longest;
                }};
    }
};

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

TEST_CASE("cores enough find the pupil in a quarter of the time of one") {
    // 14 looks of 6 blocks, the 29 steps of a first outline, and 6 of each of the two between: of all blocks a fifth. A
    // few more where a look follows its box, or an outline is not near the expected one.
    for (const char* name : {"double-gauss-50mm", "tessar-50mm", "singlet-100mm"}) {
        CAPTURE(std::string(name));
        const LensSystem lens = io::read_lens(name);
        Blocks blocks;
        const Pupil pupil(lens, half_diagonal(lens), blocks.tracer());
        CAPTURE(blocks.all);
        CAPTURE(blocks.in_a_row);
        CHECK(4 * blocks.in_a_row <= blocks.all);
    }
}

TEST_CASE("a camera of the same lens and film takes over the last one's pupil, and any other finds its own") {
    std::atomic<int> blocks{0};
    LastSetup last;
    Camera camera = camera_with(io::read_lens("singlet-100mm"), CameraModel::full_lens);
    const auto first = last.make(camera, counting(blocks));
    const int once = blocks;
    REQUIRE(once > 100);

    camera.pose.position_m = {1, 2, 3};
    camera.iso = 400;
    camera.film.width *= 2;
    const auto moved = last.make(camera, counting(blocks));
    CHECK(blocks == once);
    CHECK(moved->camera().pose == camera.pose);
    CHECK(moved->view({0, 0, 0}).width == camera.film.width);
    CHECK(moved->view({0, 0, 0}).pupil.nodes == first->view({0, 0, 0}).pupil.nodes);

    Camera wrong = camera;
    wrong.iso = -1;
    CHECK_THROWS_AS(last.make(wrong, counting(blocks)), InputError);
    last.make(camera, counting(blocks));
    CHECK(blocks == once);

    // The planner takes pictures of other films and with other models between two pictures of a camera.
    Camera probe = camera;
    probe.model = CameraModel::pinhole;
    probe.film.width_mm *= 0.5;
    last.make(probe, counting(blocks));
    last.make(camera, counting(blocks));
    CHECK(blocks == once);

    camera.lens = stopped_down(camera.lens, 16);
    const auto stopped = last.make(camera, counting(blocks));
    CHECK(blocks > once);
    CHECK(!same_pupil(stopped->view({0, 0, 0}).pupil, first->view({0, 0, 0}).pupil));
    const int twice = blocks;
    camera.film.width_mm *= 0.5;
    last.make(camera, counting(blocks));
    CHECK(blocks > twice);
}

TEST_CASE("from frame to frame a pupil is found in less than half of the blocks") {
    // The film shows the edge of the image of the fisheye and the phone lens; their outlines change in all rows.
    for (const char* name : {"double-gauss-50mm", "fisheye-6mm-220deg", "phone-4mm"}) {
        CAPTURE(std::string(name));
        const LensSystem lens = io::read_lens(name);
        const double radius = half_diagonal(lens);
        const Pupil before(focused(lens, 4000), radius);
        Blocks anew, near;
        const LensSystem next = focused(lens, 4010);
        const Pupil whole(next, radius, anew.tracer()), moved(next, radius, near.tracer(), {}, &before);
        CHECK(moved.was_found_near_similar());
        CHECK(2 * near.all <= anew.all);
        CHECK(2 * near.in_a_row <= anew.in_a_row);
    }
}

TEST_CASE("errors of pupils that are found near others do not add up") {
    // Each search starts from the last pupil that was found from scratch; here its image reaches the edge of the film.
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    const double radius = half_diagonal(lens);
    const Pupil first(focused(lens, 4000), radius);
    const LensSystem end = focused(lens, 4200);
    Pupil moved = first;
    for (const double distance : {4050.0, 4100.0, 4150.0, 4200.0})
        moved = Pupil(focused(lens, distance), radius, {}, {}, &moved);
    CHECK(moved.was_found_near_similar());
    CHECK(same_pupil(moved.view(), Pupil(end, radius, {}, {}, &first).view()));
}

TEST_CASE("only where it may is a camera's pupil found near the last one's") {
    LastSetup last;
    Camera camera = camera_with(io::read_lens("double-gauss-50mm"), CameraModel::full_lens);
    const auto at = [&](double distance, PupilStart start) {
        camera.lens = focused(camera.lens, distance);
        return last.make(camera, fast_pupil_tracer(), {}, start);
    };
    CHECK(at(4000, PupilStart::near_last)->has_new_pupil());
    CHECK(at(4010, PupilStart::from_scratch)->has_new_pupil());
    for (const double distance : {4020.0, 4030.0}) CHECK(!at(distance, PupilStart::near_last)->has_new_pupil());
    const auto still = at(4030, PupilStart::near_last);
    CHECK(still->has_new_pupil());
    CHECK(same_pupil(still->view({0, 0, 0}).pupil, CameraSetup(camera, fast_pupil_tracer()).view({0, 0, 0}).pupil));
}

TEST_CASE("threads that make cameras ready at once each get their own") {
    LastSetup last;
    const LensSystem lens = io::read_lens("singlet-100mm");
    std::vector<std::shared_ptr<const CameraSetup>> setups(12);
    on_five_threads(static_cast<int>(setups.size()), [&](int i) {
        Camera camera = camera_with(i % 2 == 0 ? lens : stopped_down(lens, 16), CameraModel::full_lens);
        camera.iso = 100 + i;
        setups[static_cast<std::size_t>(i)] = last.make(camera, fast_pupil_tracer());
    });
    for (std::size_t i = 0; i < setups.size(); ++i) {
        CHECK(setups[i]->camera().iso == 100 + static_cast<double>(i));
        CHECK(same_pupil(setups[i]->view({0, 0, 0}).pupil, setups[i % 2]->view({0, 0, 0}).pupil));
    }
    CHECK(!same_pupil(setups[0]->view({0, 0, 0}).pupil, setups[1]->view({0, 0, 0}).pupil));
}
