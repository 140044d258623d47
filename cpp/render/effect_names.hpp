#pragma once
#include <array>
#include <string>
#include <vector>

#include "../camera/camera.hpp"
#include "effects.hpp"

namespace REALCAM_NAMESPACE {

struct EffectInfo {
    const char* name;  ///< on the command line, in shot files and in Python; with a "-" before it: left out; with "="
                       ///< and a number behind it: with that parameter
    const char* line;  ///< what it is, and what it needs of lens, scene and camera
    bool EffectChoice::* member;
    double EffectChoice::* parameter = nullptr;  ///< null: it has none

    /// Where nobody names it.
    constexpr bool is_on() const { return EffectChoice{}.*member; }
};

inline constexpr std::array<EffectInfo, 7> kEffects = {{
    {"dispersion",
     "each sample has a wavelength of its own, for which every glass has its own index; needs glasses with more than "
     "one index, nothing of the scene, and the camera model full",
     &EffectChoice::dispersion},
    {"coatings",
     "each surface of the lens takes from the light what its glass and coating reflect, or its mirror keeps; needs "
     "coatings in the lens file (glass of which it says nothing is taken as bare), nothing of the scene, and the "
     "camera "
     "model full",
     &EffectChoice::coatings},
    {"ghosts",
     "light that two surfaces of the lens reflect on its way to the film, from all lights and objects of the scene; "
     "needs coatings in the lens file (glass of which it says nothing is taken as bare), lights, and the camera model "
     "full; ghosts=1e-8 leaves out those with less than 1e-8 of the lens's light, where ghosts alone means 1e-6",
     &EffectChoice::ghosts, &EffectChoice::ghost_share},
    {"film_reflection",
     "light that the film or sensor reflects like a mirror, and then a surface of the lens back to it; needs what "
     "ghosts needs; film_reflection=0.1 reflects a tenth, where film_reflection alone means 0.05",
     &EffectChoice::film_reflection, &EffectChoice::film_reflectance},
    {"diffraction",
     "the edges of the aperture spread light of each wavelength over the film, and make stars of lamps; needs nothing "
     "of "
     "lens, scene and camera",
     &EffectChoice::diffraction},
    {"motion_blur",
     "what moves while the shutter is open is blurred; needs objects or a camera that move; on unless left out, "
     "as -motion_blur",
     &EffectChoice::motion_blur},
    {"rolling_shutter",
     "the rows of pixels are exposed one after the other; needs a readout time of the camera, and objects or a "
     "camera that move; on unless left out, as -rolling_shutter",
     &EffectChoice::rolling_shutter},
}};

/// Of EffectChoice::named.
inline std::uint32_t bit_of(const EffectInfo& effect) {
    return 1u << (&effect - kEffects.data());
}

/// By the name in kEffects; null for one that is none.
const EffectInfo* find_effect(const std::string& name);

std::string effect_names();

/// Those that are switched on or left out, as effects_named understands them.
std::vector<std::string> names_of(const EffectChoice& effects);

/// "none" stands alone. Throws InputError for a name that is none, and where one is both named and left out.
EffectChoice effects_named(const std::vector<std::string>& names);

/// What lens, scene and camera cannot give of the effects, a sentence each. The picture is taken without it.
std::vector<std::string> effect_notices(const EffectChoice& effects, const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
