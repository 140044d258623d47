// Behaviour common to all sessions, with a device that only records its requests.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bare_scene.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "optics/lens/focus.hpp"
#include "render/session/live_view.hpp"
#include "render/session/take_picture.hpp"

using namespace realcam;

namespace {

class NotedFrame final : public LiveFrame {
public:
    explicit NotedFrame(std::int64_t samples, const std::atomic<bool>& stopped)
        : samples_(samples), stopped_(stopped) {}
    int width() const override { return 1; }
    int height() const override { return 1; }
    std::int64_t samples() const override { return samples_; }
    bool wait_for(std::chrono::microseconds longest) const override {
        if (!is_there && !stopped_) std::this_thread::sleep_for(longest);
        return is_there || stopped_;
    }
    const std::uint8_t* codes() const override { return nullptr; }

    std::atomic<bool> is_there{false};

private:
    std::int64_t samples_;
    const std::atomic<bool>& stopped_;
};

class NotedSession final : public Session {
public:
    std::string name() const override { return "notes"; }

    std::vector<std::string> notes;
    std::vector<SampleRange> taken, seen;
    std::function<void()> while_taking, while_seeing;
    std::vector<std::shared_ptr<NotedFrame>> frames;
    bool fails = false;
    std::atomic<bool> stop_flag{false};

private:
    void prepare(const Assembly&, const Camera& camera, const RenderSettings&, PupilStart start, const KeepGoing&,
                 OwnStop&) override {
        notes.push_back("prepare");
        if (fails) throw DeviceError("lost");
        has_new_pupil_ = start == PupilStart::from_scratch || lens_ == camera.lens || lens_.surfaces.empty();
        lens_ = camera.lens;
    }
    bool has_new_pupil() const override { return has_new_pupil_; }
    void clear() override { notes.push_back("clear"); }
    void take_samples(const SampleRange& range, const PixelCounts&, bool, std::atomic<std::int64_t>& done,
                      OwnStop&) override {
        notes.push_back("take");
        taken.push_back(range);
        if (while_taking) while_taking();
        done += range.count;
        if (fails) throw DeviceError("lost");
    }
    std::shared_ptr<LiveFrame> start_frame(const std::vector<SampleRange>& ranges, ToneCurve,
                                           std::shared_ptr<void>) override {
        for (const SampleRange& range : ranges) taken.push_back(range);
        return frames.emplace_back(std::make_shared<NotedFrame>(samples(), stop_flag));
    }
    Image develop() override { return {}; }
    std::vector<float> develop_traced() override { return {}; }
    std::vector<LayerImage> develop_auxiliary_layers() override { return {{Layer::variance, {0, 0, 0}, {}}}; }
    RegionSums take_region(const FilmRegion& region, const SampleRange& range, const PixelCounts&,
                           std::atomic<std::int64_t>&, OwnStop&) override {
        notes.push_back("take region");
        taken.push_back(range);
        if (while_taking) while_taking();
        return {FilmSums(region.pixels()), {}};
    }
    std::vector<SplatFilm> take_splats(const SampleRange& range, OwnStop&) override {
        notes.push_back("take splats");
        taken.push_back(range);
        return {};
    }
    void trace_layers(const FilmRegion&, const SampleRange& range, std::vector<LayerSum>& film,
                      std::atomic<std::int64_t>& done, OwnStop&) override {
        notes.push_back("see layers");
        seen.push_back(range);
        if (while_seeing) while_seeing();
        for (LayerSum& sum : film) sum.weight += range.count;
        done += range.count;
    }
    void trace_pixel_centres(std::vector<PixelCentreSurface>& film, OwnStop&) override {
        notes.push_back("see middle");
        for (PixelCentreSurface& surface : film) surface = {1.5f, {0, 0, 1}, 0, kNoInstance, 0, {0, 0, -1.5f}};
    }
    std::vector<std::int64_t> count_samples() override { return {samples()}; }
    PlacedCamera placed_camera() const override { return {}; }
    std::size_t frames_in_flight() const override { return 2; }
    void raise_stop() noexcept override {
        ++raised_;
        stop_flag = true;
    }
    void lower_stop() noexcept override { stop_flag = --raised_ > 0; }
    bool is_stopped() const override { return stop_flag; }

    std::atomic<int> raised_{0};
    LensSystem lens_{};
    bool has_new_pupil_ = true;
};

Camera small_camera() {
    Camera camera;
    camera.lens = io::read_lens("tessar-50mm");
    camera.film.width = camera.film.height = 1;
    return camera;
}

const std::vector<std::string> kAnew = {"prepare", "clear", "take"}, kOn = {"take"};

}  // namespace

TEST_CASE("a session prepares what is another picture, and goes on with what is the same") {
    Assembly scene(test::bare_scene());
    scene.instances.push_back({std::make_shared<const Scene>(test::bare_scene()), {}, "chair"});
    Camera camera = small_camera();
    RenderSettings settings{.effects = {}};
    NotedSession session;
    CHECK_THROWS_WITH_AS(session.add(1), "there is no scene to photograph yet; set() sets scene, camera and settings",
                         InputError);
    const auto next = [&] {
        session.notes.clear();
        session.set(scene, camera, settings);
        session.add(2);
        return session.notes;
    };
    CHECK(next() == kAnew);
    CHECK(next() == kOn);
    CHECK(session.picture().spp == 4);
    camera.iso = 1600;
    camera.exposure_time_s = 3;
    settings.spp = 7;
    settings.threads = 2;
    CHECK(next() == kOn);

    const std::vector<std::function<void()>> changes = {
        [&] { camera.pose.position_m.x += 1; },
        [&] { camera.lens = focused(camera.lens, 2000); },
        [&] { camera.film.width_mm *= 0.5; },
        [&] { camera.model = CameraModel::thin_lens; },
        [&] { settings.seed = 1; },
        [&] { settings.max_bounces = 3; },
        [&] { scene.instances[0].scene_from_object.origin.y = 1; },
        [&] { scene = Assembly(test::bare_scene()); },
    };
    for (const auto& change : changes) {
        change();
        CHECK(next() == kAnew);
        CHECK(session.picture().spp == 2);
    }
    session.restart();
    CHECK_THROWS_AS(session.picture(), InputError);
    CHECK(next() == std::vector<std::string>{"clear", "take"});
}

TEST_CASE("samples go on where the last ended, also after a stop; a failure begins anew") {
    const Assembly scene(test::bare_scene());
    const Camera camera = small_camera();
    NotedSession session;
    session.set(scene, camera, {.effects = {}});
    session.add(3);
    std::thread stop;
    session.while_taking = [&] {
        stop = std::thread([&] { session.cancel(); });
        while (!session.stop_flag) std::this_thread::yield();
    };
    CHECK_THROWS_AS(session.add(4), Cancelled);
    stop.join();
    session.while_taking = {};
    session.add(5);
    CHECK(session.taken.back().first == 7);
    CHECK(session.taken.back().count == 5);
    CHECK(session.sample_counts().counts == std::vector<std::int64_t>{12});

    session.cancel(OnCancel::drop);
    CHECK_THROWS_WITH_AS(session.picture(), "there is no picture yet; it needs samples first", InputError);
    CHECK(session.sample_counts().counts == std::vector<std::int64_t>{0});
    session.add(1);
    CHECK(session.taken.back().first == 0);

    session.fails = true;
    CHECK_THROWS_AS(session.add(1), DeviceError);
    session.fails = false;
    CHECK_THROWS_AS(session.add(1), InputError);
    session.notes.clear();
    session.set(scene, camera, {.effects = {}});
    session.add(1);
    CHECK(session.notes == kAnew);
    CHECK(session.taken.back().first == 0);
}

TEST_CASE("as many frames are under way as the device takes") {
    const Camera camera = small_camera();
    auto owned = std::make_unique<NotedSession>();
    NotedSession& session = *owned;
    LiveView view(std::move(owned), test::bare_scene());
    CHECK_THROWS_AS(view.collected(), InputError);
    CHECK(view.shoot(camera, {.spp = 2, .effects = {}}, ToneCurve::film)->samples() == 2);
    CHECK(view.shoot(camera, {.spp = 3, .effects = {}}, ToneCurve::film)->samples() == 5);
    // The third call has to wait for the first, here until it is cancelled.
    int asked = 0;
    CHECK_THROWS_AS(view.shoot(camera, {.spp = 1, .effects = {}}, ToneCurve::film, [&] { return ++asked < 3; }),
                    Cancelled);
    CHECK(asked == 3);
    CHECK(session.frames.size() == 2);
    session.frames[0]->is_there = true;
    CHECK(view.shoot(camera, {.spp = 1, .effects = {}}, ToneCurve::film)->samples() == 6);
    CHECK_THROWS_AS(view.shoot(camera, {.spp = 0, .effects = {}}, ToneCurve::film), InputError);
    view.cancel();
    CHECK_THROWS_AS(view.collected().picture(), InputError);
    CHECK(view.shoot(camera, {.spp = 1, .effects = {}}, ToneCurve::film)->samples() == 1);
    view.show(test::bare_scene());
    CHECK_THROWS_AS(view.collected(), InputError);
    session.stop_flag = true;  // so that the frames under way end
}

TEST_CASE("layers catch up with the samples of a picture, and are seen once") {
    const Assembly scene(test::bare_scene());
    Camera camera = small_camera();
    RenderSettings settings{.effects = {}};
    NotedSession session;
    session.set(scene, camera, settings);
    session.add(3);
    CHECK(session.picture().layers.empty());
    CHECK(session.seen.empty());

    // Wanted later, and of the same picture: its samples are seen from the first on.
    settings.layers = {Layer::circle_of_confusion_mm, Layer::depth_middle, Layer::object_id, Layer::sample_count};
    session.set(scene, camera, settings);
    Image image = session.picture();
    CHECK(session.taken.size() == 1);
    REQUIRE(session.seen.size() == 1);
    CHECK(session.seen[0].first == 0);
    CHECK(session.seen[0].count == 3);
    REQUIRE(image.layers.size() == 4);
    CHECK(image.layers[1].numbers == std::vector<std::uint32_t>{3});
    CHECK(image.layers[2].values == std::vector<float>{1.5f});
    CHECK(image.layers[3].numbers == std::vector<std::uint32_t>{1});
    CHECK(image.object_names == IdNames{"", "static geometry"});
    CHECK(image.material_names.empty());
    session.notes.clear();
    session.add(2);
    CHECK(session.notes == std::vector<std::string>{"take", "see layers"});
    CHECK(session.seen.back().first == 3);
    CHECK(session.seen.back().count == 2);
    session.picture();
    CHECK(session.notes.size() == 2);

    // A layer that is cancelled half-way does not count.
    std::thread stop;
    session.while_seeing = [&] {
        stop = std::thread([&] { session.cancel(); });
        while (!session.stop_flag) std::this_thread::yield();
    };
    CHECK_THROWS_AS(session.add(1), Cancelled);
    stop.join();
    session.while_seeing = {};
    session.picture();
    CHECK(session.seen.back().first == 0);
    CHECK(session.seen.back().count == 6);

    // Another camera position starts a new picture; so does a picture whose squares were not summed.
    camera.pose.position_m.x += 1;
    session.set(scene, camera, settings);
    session.add(1);
    CHECK(session.seen.back().first == 0);
    CHECK(session.seen.back().count == 1);
    settings.layers = {Layer::variance};
    session.notes.clear();
    session.set(scene, camera, settings);
    session.add(1);
    CHECK(session.notes == kAnew);
    image = session.picture();
    REQUIRE(image.layers.size() == 1);
    CHECK(image.layers[0].layer == Layer::variance);
    settings.layers = {};
    session.notes.clear();
    session.set(scene, camera, settings);
    session.add(1);
    CHECK(session.notes == kOn);
    // Squares lie where something else is summed of samples with wavelengths.
    settings.effects.dispersion = true;
    for (const LayerSet layers : {LayerSet{Layer::variance}, LayerSet{}}) {
        settings.layers = layers;
        session.notes.clear();
        session.set(scene, camera, settings);
        session.add(1);
        CHECK(session.notes == kAnew);
    }
}

TEST_CASE("a view that stands still is a new session's picture, whatever lens was before") {
    const Assembly scene(test::bare_scene());
    Camera camera = small_camera();
    NotedSession session;
    const auto samples_of_frame = [&] {
        const auto frame = session.shoot(scene, camera, {.spp = 2, .effects = {}}, ToneCurve::film);
        session.frames.back()->is_there = true;
        return frame->samples();
    };
    const auto count_prepared = [&] { return std::count(session.notes.begin(), session.notes.end(), "prepare"); };
    CHECK(samples_of_frame() == 2);
    CHECK(samples_of_frame() == 4);  // there was no pupil near which it could be found
    for (const double distance : {2000.0, 1900.0}) {
        camera.lens = focused(camera.lens, distance);
        CHECK(samples_of_frame() == 2);
    }
    CHECK(count_prepared() == 3);
    session.set(scene, camera, {.effects = {}});  // the accumulated film can still be developed
    CHECK(session.picture().spp == 2);
    CHECK(count_prepared() == 3);
    CHECK(samples_of_frame() == 2);
    CHECK(count_prepared() == 4);
    CHECK(samples_of_frame() == 4);
    CHECK(count_prepared() == 4);
}

TEST_CASE("parts of a picture are exposed apart from it, in steps that whole pictures add up in") {
    const Assembly scene(test::bare_scene());
    Camera camera = small_camera();
    camera.film.width = 5;
    camera.film.height = 4;
    NotedSession session;
    CHECK_THROWS_WITH_AS(session.sample_region({0, 0, 1, 1}, 0, 1),
                         "there is no scene to photograph yet; set() sets scene, camera and settings", InputError);
    RenderSettings settings{.seed = 9, .effects = {}};
    session.set(scene, camera, settings);
    session.add(3);
    session.notes.clear();
    CHECK(session.sample_region({3, 1, 2, 3}, 256, 44).pixels.size() == 6);
    CHECK(session.taken.back().seed == 9);
    CHECK(session.taken.back().first == 256);
    CHECK(session.taken.back().count == 44);
    CHECK(session.layer_sums_of_region({3, 1, 2, 3}, 0, 256).size() == 6);
    CHECK(session.sample_splats(0, 0).empty());
    CHECK(session.notes == std::vector<std::string>{"take region", "see layers", "take splats"});
    CHECK(session.picture().spp == 3);

    const char* kOutside = "a region must lie on the film, which has 5 x 4 pixels";
    for (const FilmRegion region : {FilmRegion{-1, 0, 2, 2},
                                    {0, -1, 2, 2},
                                    {4, 0, 2, 2},
                                    {0, 3, 1, 2},
                                    {0, 0, 0, 2},
                                    {0, 0, 2147483647, 2},
                                    {2147483647, 0, 2147483647, 1}}) {
        CHECK_THROWS_WITH_AS(session.sample_region(region, 0, 1), kOutside, InputError);
        CHECK_THROWS_WITH_AS(session.layer_sums_of_region(region, 0, 1), kOutside, InputError);
    }
    CHECK_THROWS_AS(session.sample_region({0, 0, 1, 1}, 0, 257), InputError);
    CHECK_THROWS_AS(session.sample_region({0, 0, 1, 1}, -1, 1), InputError);
    CHECK_THROWS_AS(session.sample_region({0, 0, 1, 1}, std::int64_t{1} << 32, 1), InputError);
    CHECK_THROWS_AS(session.sample_region({0, 0, 1, 1}, 0, 2, {1, 1}), InputError);
    CHECK_THROWS_AS(session.picture_of({FilmSums(19), {}, {}, {}}), InputError);
    settings.pupil_sampling = PupilSampling::pixel;
    session.set(scene, camera, settings);
    CHECK_THROWS_AS(session.sample_region({0, 0, 1, 1}, 0, 1), InputError);
}

TEST_CASE("a part that is stopped is no part, and the session goes on") {
    NotedSession session;
    session.set(Assembly(test::bare_scene()), small_camera(), {.effects = {}});
    session.while_taking = [&] {
        while (!session.stop_flag) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    CHECK_THROWS_AS(session.sample_region({0, 0, 1, 1}, 0, 1, {}, [](double) { return false; }), Cancelled);
    session.while_taking = {};
    CHECK(session.sample_region({0, 0, 1, 1}, 0, 1).pixels.size() == 1);
}

TEST_CASE("a picture is developed of what was collected elsewhere") {
    Camera camera = small_camera();
    camera.exposure_time_s = 2;
    RenderSettings settings{.layers = {Layer::variance, Layer::sample_count, Layer::depth_middle}, .effects = {}};
    NotedSession session;
    session.set(Assembly(test::bare_scene()), camera, settings);
    AccumulatedFilm film{FilmSums(1), {}, {}, {}};
    film.pixels[0] = {{9, 0, 3}, {41, 0, 3}, 0, 0, 3, 3};
    film.stats.sampled_rays = 77;
    const Image image = session.picture_of(film);
    CHECK(image.exposure[0] == 6);  // 9 lux over 3 samples, 2 s
    CHECK(image.exposure[2] == 2);
    CHECK(image.spp == 3);
    CHECK(image.stats.sampled_rays == 77);
    REQUIRE(image.layers.size() == 3);
    CHECK(image.layers[0].numbers == std::vector<std::uint32_t>{3});
    CHECK(double(image.layers[1].values[0]) == doctest::Approx(28.0 / 3));
    CHECK(image.layers[2].values == std::vector<float>{1.5f});
    CHECK_THROWS_AS(session.picture(), InputError);  // the session itself has no samples
}
