// Every set of effects that a user can ask for is served by code that was compiled, and that code knows what may be
// missing.

#include <cstring>
#include <iterator>
#include <vector>

#include "doctest/doctest.h"
#include "render/settings/effect_names.hpp"

namespace {

using namespace realcam;

std::vector<const EffectInfo*> compiled_effects() {
    std::vector<const EffectInfo*> effects;
    for (const EffectInfo& effect : kEffects)
        if (effect.is_compiled()) effects.push_back(&effect);
    return effects;
}

/// All subsets of the effects that have code of their own.
std::vector<Effects> all_sets() {
    const std::vector<const EffectInfo*> effects = compiled_effects();
    std::vector<Effects> sets;
    for (unsigned bits = 0; bits < 1u << effects.size(); ++bits) {
        EffectChoice choice;
        for (std::size_t i = 0; i < effects.size(); ++i) choice.*effects[i]->member = (bits >> i & 1u) != 0;
        sets.push_back(choice);
    }
    return sets;
}

TEST_CASE("no two effects share a name or a switch") {
    for (const EffectInfo& a : kEffects)
        for (const EffectInfo& b : kEffects)
            if (&a != &b) CHECK((std::strcmp(a.name, b.name) != 0 && a.member != b.member));
}

TEST_CASE("each set of effects gets the smallest code that holds it") {
    for (const Effects& wanted : all_sets()) {
        const int number = number_of(wanted);
        REQUIRE(number < static_cast<int>(std::size(kCompiledEffects)));
        const Effects& served = kCompiledEffects[number];
        CHECK(served.hold(wanted));
        for (const Effects& other : kCompiledEffects)
            if (other.hold(wanted) && served.hold(other)) CHECK(other == served);
        if (served.coatings && !wanted.coatings) CHECK(may_lack_coatings(served));
        // Its samples have wavelengths if, and only if, those of the picture have.
        CHECK(served.have_wavelengths() == wanted.have_wavelengths());
    }
}

}  // namespace
