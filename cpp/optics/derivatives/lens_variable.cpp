#include "lens_variable.hpp"

#include <string>

#include "../lens/lens_changes.hpp"

namespace realcam {

namespace {

/// Throws InputError with the message "surface N `why`"; N counts from 1.
[[noreturn]] void fail(int surface, const std::string& why) {
    throw InputError("surface " + std::to_string(surface + 1) + " " + why);
}

/// Throws InputError unless v.number is from `first` to `last`. `what`: predicate of the message, such as "has axes".
void check_number(const LensVariable& v, int first, int last, const std::string& what) {
    if (v.number < first || v.number > last)
        fail(v.surface, what + " from " + std::to_string(first) + " to " + std::to_string(last) + "; found " +
                            std::to_string(v.number));
}

/// Checks a variable of LensQuantity::terms.
void check_terms(const LensVariable& v, const SurfaceForm& form) {
    if (v.row < 0 || v.row >= static_cast<int>(kFormTermsCount))
        fail(v.surface, "has no terms of row " + std::to_string(v.row) + " of the table of forms");
    const FormNames& words = kFormNames[static_cast<std::size_t>(v.row)];
    const std::string name = words.name;
    int row = 0;
    for_each_kind_of_terms(form, [&](const auto& terms) {
        if (row++ != v.row) return;
        if (!terms) fail(v.surface, "has no " + name + " terms");
        const int count = static_cast<int>(terms->coefficients.size());
        check_number(v, words.first_number, words.first_number + count - 1, "has " + name + " terms");
    });
}

/// Checks a variable of the surface's form (surface_form.hpp).
void check_form(const LensVariable& v, const SurfaceForm& form) {
    switch (v.quantity) {
        case LensQuantity::curvature_x:
            if (form.base == BaseForm::conic) fail(v.surface, "has one radius; a biconic or toroid has two");
            break;
        case LensQuantity::conic_x:
            if (form.base != BaseForm::biconic) fail(v.surface, "has one conic constant; a biconic has two");
            if (form.curvature_x == 0) fail(v.surface, "is straight along x: its conic there has no effect");
            break;
        case LensQuantity::radial:
            if (form.adds_nothing()) fail(v.surface, "has no terms of r");
            check_number(v, 1, kMaxRadialTerms, "has terms of r");
            break;
        case LensQuantity::xy:
            if (form.adds_nothing()) fail(v.surface, "has no terms of x and y");
            if (v.number < 0 || v.number_y < 0 || v.number + v.number_y < 1 || v.number + v.number_y > kMaxXyDegree)
                fail(v.surface, "has terms of x and y up to the degree " + std::to_string(kMaxXyDegree));
            break;
        case LensQuantity::terms: check_terms(v, form); break;
        default: break;
    }
}

/// Throws InputError if the lens does not have the variable, or if it has no effect.
void check(const LensSystem& lens, const LensVariable& v) {
    if (v.quantity == LensQuantity::film_distance) return;
    check_surface_exists(lens, v.surface);
    const Surface& surface = lens.surfaces[static_cast<std::size_t>(v.surface)];
    switch (v.quantity) {
        case LensQuantity::thickness:
            if (v.surface + 1 == static_cast<int>(lens.surfaces.size()))
                fail(v.surface, "is the last and has no thickness; the film follows it");
            return;
        case LensQuantity::decentre:
        case LensQuantity::tilt: return check_number(v, 0, 2, "has axes");
        case LensQuantity::index:
            if (surface.type != SurfaceType::refracting)
                fail(v.surface, "has the same medium on both sides: name the index of the surface before it");
            return;
        default: break;
    }
    if (!surface.bends_light()) fail(v.surface, "is a plane that only blocks light, and has no shape to change");
    if (v.quantity == LensQuantity::conic && surface.curvature == 0)
        fail(v.surface, "is a plane: its conic has no effect");
    if (v.quantity == LensQuantity::aspheric &&
        (v.number % 2 != 0 || v.number < 4 || v.number > 2 + 2 * kMaxAsphericTerms))
        fail(v.surface, "has aspheric terms of the powers 4, 6, ..., " + std::to_string(2 + 2 * kMaxAsphericTerms) +
                            "; found " + std::to_string(v.number));
    check_form(v, surface.form);
}

}  // namespace

void check_variables(const LensSystem& lens, const std::vector<LensVariable>& variables) {
    for (const LensVariable& variable : variables) check(lens, variable);
}

}  // namespace realcam
