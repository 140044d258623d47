#pragma once
// The hard lenses, in the groups of docs/generated/numerics.md.

#include <string>
#include <vector>

#include "hard_lenses.hpp"
#include "optics/lens/paraxial.hpp"

namespace realcam::test {

struct HardLens {
    std::string name;
    LensSystem lens;
};
struct LensGroup {
    std::string what;
    std::vector<HardLens> lenses;
    bool float32_images = true;  ///< false for aspheres: test_float32_error.py tests theirs, at the lenses' own size
};

/// Two glasses whose air gap has no thickness, once with equal radii and once overlapping at the rim.
inline LensSystem contact_doublet(bool overlapping) {
    const Glass crown = Glass::constant(1.5), flint = Glass::constant(1.7);
    return focused(overlapping
                       ? lens_of({stop_plane(1, 10), refracting(25, 3, crown, 13), refracting(40, 0, Glass::air(), 12),
                                  refracting(-60, 3, flint, 12), refracting(-55, 0, Glass::air(), 12)})
                       : lens_of({stop_plane(3, 8), refracting(60, 6, crown, 12), refracting(-60, 0, Glass::air(), 12),
                                  refracting(-60, 4, flint, 12), refracting(300, 0, Glass::air(), 12)}),
                   kInfinity);
}

/// A lens with plates and stops of no thickness, and of a millionth of a micrometre, in its air.
inline LensSystem with_thin_plates(LensSystem lens) {
    const auto gap = lens.surfaces.begin() + lens.stop_index() + 1;
    const double rim = lens.stop().clear_semi_diameter * 1.1;
    std::vector<Surface> thin;
    for (const double thickness : {0.0, 1e-9}) {
        thin.push_back(refracting(0, thickness, Glass::constant(1.6), rim));
        thin.push_back(refracting(0, thickness, Glass::air(), rim));
        Surface aperture = stop_plane(thickness, rim);
        aperture.type = SurfaceType::aperture;
        thin.push_back(aperture);
    }
    lens.surfaces.insert(gap, thin.begin(), thin.end());
    lens.allow_overlap = true;  // the faces beside the stop reach through the plates
    return lens;
}

inline std::vector<LensGroup> hard_lenses() {
    const auto bundled = [](const char* name) { return io::read_lens(name); };
    const LensSystem gauss = bundled("double-gauss-50mm"), phone = bundled("phone-4mm");
    const double per_mm = 1 / first_order(gauss, gauss.wavelength_nm).effective_focal_length;
    const double phone_per_mm = 1 / first_order(phone, phone.wavelength_nm).effective_focal_length;
    std::vector<Surface> fifty = plates(50, 1.1, 20);
    fifty.insert(fifty.begin(), stop_plane(1, 2));
    LensSystem most = relays(127, 1);
    most.surfaces.insert(most.surfaces.begin() + 1, most.surfaces[0]);
    most.surfaces[1].type = SurfaceType::aperture;
    most.surfaces[0].thickness = 0;
    LensSystem large = scaled(gauss, 7.5);
    large.film_width = 254, large.film_height = 203.2;
    const LensSystem on_glass =
        with_film(lens_of({stop_plane(2, 5), refracting(30, 0, Glass::constant(1.5), 12)}), 90, 20);
    return {
        {"fisheyes of 220 and 296 degrees",
         {{"220 degrees", bundled("fisheye-6mm-220deg")}, {"296 degrees", fisheye_270()}}},
        {"mirror lenses",
         {{"two Mangin mirrors", bundled("mirror-telephoto-500mm")}, {"two conics", Cassegrain::lens()}}},
        {"f/0.7 and f/128", {{"f/0.7", FastLens::lens()}, {"f/128", stopped_down(gauss, 128)}}},
        {"focal lengths of 1 mm and 2 m", {{"1 mm", scaled(gauss, per_mm)}, {"2 m", scaled(gauss, 2000 * per_mm)}}},
        {"12 aspheres, focal lengths of 1 mm and 2 m",
         {{"phone of 1 mm", scaled(phone, phone_per_mm)}, {"phone of 2 m", scaled(phone, 2000 * phone_per_mm)}},
         false},
        {"films of 1 mm and of 8 x 10 inches",
         {{"1 mm", with_film(gauss, gauss.film_distance, 1)}, {"8 x 10 inches", large}}},
        {"afocal attachments x2 and x0.5",
         {{"x2", with_film(focused(in_front(galilean(30, 10), gauss), kInfinity), 36.1, 14)},
          {"x0.5", with_film(focused(in_front(reversed_galilean(30, 10), gauss), kInfinity), 36.1, 20)}}},
        {"stop in front of, in and behind the glass",
         {{"in front", singlet_with_stop(15, 0)},
          {"in the glass", singlet_with_stop(0, 0, true)},
          {"behind", singlet_with_stop(0, 15)}}},
        {"surfaces cemented, in contact, overlapping, 0 and 1e-9 mm apart",
         {{"cemented", bundled("achromat-75mm")},
          {"in contact", contact_doublet(false)},
          {"overlapping", contact_doublet(true)},
          {"thin plates", with_thin_plates(gauss)}}},
        {"1, 2, 101 and 256 surfaces",
         {{"a stop alone", with_film(lens_of({stop_plane(0, 1)}), 50, 20)},
          {"film under glass", on_glass},
          {"50 plates", with_film(lens_of(fifty), 50, 10)},
          {"50 relays", relays(50, 1)},
          {"256 surfaces", most}}},
    };
}

}  // namespace realcam::test
