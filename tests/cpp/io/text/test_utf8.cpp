#include <string>

#include "doctest/doctest.h"
#include "io/text/printable.hpp"

using namespace realcam::io;

TEST_CASE("every code point is written in UTF-8 as RFC 3629 says, and read again") {
    // The last code point of each size.
    constexpr unsigned last[] = {0x7f, 0x7ff, 0xffff, 0x10ffff};
    std::size_t size = 1;
    std::string all;
    for (unsigned point = 0; point <= 0x10ffff; ++point) {
        while (point > last[size - 1]) ++size;
        std::string text;
        append_utf8(text, point);
        const bool is_surrogate = point >= 0xd800 && point < 0xe000;
        if (text.size() != size || utf8_size(text) != (is_surrogate ? 0 : size)) FAIL("U+", point);
        if (size > 1 && utf8_begin("a" + text + "b", size) != 1) FAIL("the beginning of U+", point);
        if (!is_surrogate) all += text;
    }
    CHECK(is_utf8(all));
}

TEST_CASE("the examples of RFC 3629 are UTF-8, and broken bytes are not") {
    std::string text;
    for (const unsigned point : {0x41u, 0x2262u, 0x391u, 0x2eu, 0xd55cu, from_surrogates(0xd84c, 0xdfb4)})
        append_utf8(text, point);
    CHECK(text == "A\xe2\x89\xa2\xce\x91.\xed\x95\x9c\xf0\xa3\x8e\xb4");
    for (const char* broken :
         {"\x80", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x89", "a\xff"})
        CHECK_FALSE(is_utf8(broken));
}
