#include "../fuzz_run.hpp"

TEST_CASE("a mutated picture file is a picture, or an error") {
    realcam::test::hold_mutated_files("picture", realcam::fuzz::fuzz_picture);
}
