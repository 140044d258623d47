// Which random numbers a picture that is never finished draws.

#include <cstdint>

#include "doctest/doctest.h"
#include "render/path/sample_range.hpp"

using namespace realcam;

TEST_CASE("samples go on where the last ended, with the same seed, up to the end of a sequence") {
    const SampleRange range = next_samples(7, 100, 120);
    CHECK(range.seed == 7);
    CHECK(range.first == 100);
    CHECK(range.count == 20);
    const std::int64_t past_int = (std::int64_t{1} << 31) + 5;
    CHECK(next_samples(7, past_int, past_int + 1).first == (1u << 31) + 5);
}

TEST_CASE("no two samples of a picture draw the same numbers, past the 2^32 of a sequence") {
    constexpr std::int64_t kSequence = std::int64_t{1} << 32;
    const SampleRange before = next_samples(7, kSequence - 3, kSequence + 5);
    CHECK(before.seed == 7);
    CHECK(before.first == 0xfffffffd);
    CHECK(before.count == 3);
    const SampleRange after = next_samples(7, kSequence, kSequence + 5);
    CHECK(after.seed == 8);
    CHECK(after.first == 0);
    CHECK(after.count == 5);
    CHECK(next_samples(0xffffffff, 3 * kSequence + 9, 3 * kSequence + 10).seed == 2);
}
