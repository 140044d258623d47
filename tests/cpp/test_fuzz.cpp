#include "fuzz_run.hpp"

using namespace realcam;
using namespace realcam::test;
using fuzz::Findings;

TEST_CASE("fuzzed rays end with finite numbers and keep the laws of optics") {
    const double broken = run_target(fuzz::fuzz_lens_trace, &Findings::rays, 1000000);
    const Findings& all = fuzz::findings();
    CHECK(all.passed > all.rays / 40);  // it is not all waste
    hold({"Rays", "fuzzed rays that end with a NaN, an infinity or a broken invariant",
          count_of(all.rays) + " rays through drawn lenses of 2 to 102 surfaces", "Embree, all instruction sets",
          "both", broken, 0, "rays"});
}

TEST_CASE("a mutated lens file is a lens or a LensFileError") {
    const double broken = run_target(fuzz::fuzz_lens_file, &Findings::files, 400);
    CHECK(fuzz::findings().files_read > 8);
    hold({"Lenses", "mutated lens files that end in anything but a lens or a LensFileError",
          std::to_string(fuzz::findings().files) + " files", "core", "float64", broken, 0, "files"});
}

TEST_CASE("a mutated file of any kind is what it should be, or an error") {
    struct Kind {
        const char* name;
        fuzz::Target target;
    };
    const Kind kinds[] = {
        {"OBJ", fuzz::fuzz_obj},
        {"MTL", fuzz::fuzz_mtl},
        {"glTF", fuzz::fuzz_gltf},
        {"GLB", fuzz::fuzz_glb},
        {"compressed", fuzz::fuzz_compressed},
        {"PLY", fuzz::fuzz_ply},
#if defined(REALCAM_FUZZ_SHOT_FILES)
        {"shot", fuzz::fuzz_shot_file},
#endif
    };
    for (const Kind& kind : kinds) {
        CAPTURE(kind.name);
        hold_mutated_files(kind.name, kind.target);
    }
}

TEST_CASE("a camera with absurd dials is refused or its rays are finite") {
    const double broken = run_target(fuzz::fuzz_camera, &Findings::pupil_samples, 100000);
    CHECK(fuzz::findings().cameras_made > 0);
    hold({"Rays", "rays of absurd cameras, and samples of pupils at absurd film points, that are not finite",
          count_of(fuzz::findings().pupil_samples) + " samples, " + std::to_string(fuzz::findings().cameras) +
              " cameras",
          "core", "float32", broken, 0, "rays"});
}
