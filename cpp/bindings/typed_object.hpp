#pragma once
#include <pybind11/numpy.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace realcam::bindings {

/// Python type annotation as a template argument.
template <std::size_t size>
struct Annotation {
    char text[size];

    // NOLINTNEXTLINE(google-explicit-constructor): template arguments are written as string literals
    constexpr Annotation(const char (&literal)[size]) { std::copy_n(literal, size, text); }
};

/// Python object that is shown in signatures as `annotation`. pybind11 checks its type `Base` but not the annotation:
/// for values that the function converts itself.
template <Annotation annotation, class Base = pybind11::object>
struct Typed : Base {
    Typed() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): functions return the objects that they have made
    Typed(Base object) : Base(std::move(object)) {}
    Typed(const pybind11::handle& handle, pybind11::object::borrowed_t) : Base(handle, borrowed) {}
    Typed(const pybind11::handle& handle, pybind11::object::stolen_t) : Base(handle, stolen) {}

    static bool check_(const pybind11::handle& handle) { return pybind11::isinstance<Base>(handle); }

private:
    static constexpr pybind11::object::borrowed_t borrowed{};
    static constexpr pybind11::object::stolen_t stolen{};
};

// Annotations may use the type aliases of the stub (tools/make_stub.py), such as _Shot.

using PathLike = Typed<"str | os.PathLike[str]">;
/// Medium of a lens, see glass_from in bindings.hpp.
using MediumLike = Typed<"float | tuple[float, float] | str | Glass | None">;
/// Material of a coating's layer or metal, see coating_material_from in lens/bind_coating.cpp.
using CoatingMaterialLike = Typed<"complex | tuple[float, float] | Sequence[tuple[float, float, float]] | str | Glass">;
/// Coating of a surface, see coating_from in bindings.hpp.
using CoatingLike = Typed<"str | Coating">;
/// Progress function, see progress_of in bindings.hpp.
using ProgressFunction = Typed<"Callable[[float], bool | None] | None">;
using DTypeLike = Typed<"DTypeLike">;
using ArrayLike = Typed<"ArrayLike">;
using OptionalArrayLike = Typed<"ArrayLike | None">;
/// Terms of a surface's sag, its aperture, or an obscuration, as a dict; see change_form in lens/surface_changes.hpp.
using FormDict = Typed<"dict[str, Any]", pybind11::dict>;

}  // namespace realcam::bindings

template <realcam::bindings::Annotation annotation, class Base>
struct pybind11::detail::handle_type_name<realcam::bindings::Typed<annotation, Base>> {
    static constexpr auto name = const_name(annotation.text);
};
