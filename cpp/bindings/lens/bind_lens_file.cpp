// Lens.load and Lens.save.

#include <pybind11/stl.h>

#include <map>
#include <tuple>

#include "../../io/files/uri.hpp"
#include "../../io/lens/lens_format.hpp"
#include "../bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using CataloguePaths = Typed<"str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | None">;

/// Reads a lens file. Returns the lens, and notes on values that were computed or assumed. Releases the GIL; Ctrl-C
/// interrupts it.
std::pair<LensSystem, std::vector<std::string>> read_unlocked(const std::string& path, io::LensReadOptions options) {
    std::vector<std::string> notes;
    options.warn = [&](const std::string& note) { notes.push_back(note); };
    options.keep_going = heed_signals;
    const Unlocked unlocked;
    LensSystem lens = io::read_lens(path, options);
    return {std::move(lens), std::move(notes)};
}

/// Returns the lens, and the field angles in degrees and wavelengths in nm that a file of another program specifies.
/// Arguments as for Lens.load.
std::tuple<LensSystem, std::vector<double>, std::vector<double>> load_with_light(
    const PathLike& name, const std::optional<std::map<std::string, MediumLike>>& glass, bool force,
    const std::optional<std::string>& pbrt_thickness, const CataloguePaths& glass_catalogue) {
    io::LensReadOptions options;
    io::DesignLight light;
    options.design_light = &light;
    if (py::isinstance<py::list>(glass_catalogue) || py::isinstance<py::tuple>(glass_catalogue))
        for (const py::handle file : glass_catalogue)
            io::read_glass_catalogue(path_from(py::reinterpret_borrow<py::object>(file)), options.catalogue);
    else if (!glass_catalogue.is_none())
        io::read_glass_catalogue(path_from(glass_catalogue), options.catalogue);
    options.force = force;
    if (glass)
        for (const auto& [glass_name, material] : *glass)
            options.glasses.insert_or_assign(glass_name, glass_from(material));
    if (pbrt_thickness) options.pbrt_thickness = io::pbrt_thickness_named(*pbrt_thickness);
    auto [lens, notes] = read_unlocked(path_from(name), std::move(options));
    for (const std::string& note : notes) warn(note);
    return {std::move(lens), std::move(light.fields_deg), std::move(light.wavelengths_nm)};
}

LensSystem load_lens(const PathLike& name, const std::optional<std::map<std::string, MediumLike>>& glass, bool force,
                     const std::optional<std::string>& pbrt_thickness, const CataloguePaths& glass_catalogue) {
    return std::get<0>(load_with_light(name, glass, force, pbrt_thickness, glass_catalogue));
}

std::pair<LensSystem, std::vector<std::string>> read_lens_with_notes(const PathLike& path) {
    return read_unlocked(path_from(path), {});
}

/// Returns the content of a lens file in the format of the path's suffix, and notes on properties of the lens that the
/// format cannot represent.
std::pair<py::bytes, std::vector<std::string>> file_content(const LensSystem& lens, const PathLike& path) {
    const std::string file = path_from(path);
    if (io::suffix_of(file) == ".osl")
        return {py::module_::import("realcam.osl").attr("shader_text")(lens).attr("encode")(), {}};
    io::LensText text = io::lens_text_for(lens, file);
    return {py::bytes(text.text), std::move(text.warnings)};
}

void save_lens(const LensSystem& lens, const PathLike& path) {
    const py::module_ files = py::module_::import("realcam.files");
    files.attr("check_target")(path);
    const auto [content, warnings] = file_content(lens, path);
    files.attr("write_whole")(path, content);
    for (const std::string& left_out : warnings) warn("not in the file: " + left_out);
}

}  // namespace

void bind_lens_file(py::module_& m) {
    m.def("lens_names", &io::lens_names, "Returns the names of the bundled lenses.");
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def_static("load", &load_lens, "name_or_path"_a, py::kw_only(), "glass"_a = py::none(), "force"_a = false,
                    "pbrt_thickness"_a = py::none(), "glass_catalogue"_a = py::none(),
                    R"(Reads a lens.
name_or_path: name of a bundled lens or of one in the folders of REALCAM_LENS_PATH, or path of a lens file. The suffix
  determines the format: .zmx (Zemax), .seq (CODE V), .len (OSLO), .dat (pbrt), .json (Optiland), .roa (ray-optics);
  any other suffix: realcam's own format, TOML.
glass: {name in the file: material}, for glasses that no catalogue, or more than one, contains; materials as for
  Surface(), such as (n_d, V_d) or "schott:F4".
force: ignore unsupported features of the file, with a UserWarning, instead of raising LensFileError.
glass_catalogue: path of a glass catalogue (.agf), or several, which take precedence over the bundled ones.
pbrt_thickness: whether the thickness in a row of a .dat file is that "after" or "before" its surface; None: inferred
  from the first row.
Raises LensFileError with file, line and surface, and InputError if glass contains a name that is not in the file.
Missing values that are computed or assumed cause a UserWarning.)")
        .def("save", &save_lens, "path"_a,
             R"(Writes a lens file in the format of the path's suffix: .toml, from which Lens.load makes an equal lens;
.zmx, .seq, .json (Optiland) or .roa (ray-optics), with a UserWarning for each property that the format cannot
represent; .osl, a camera shader for Blender 5. Raises InputError for an unknown suffix, and for a lens that the shader
cannot represent; ImageFileError if the file cannot be written.)")
        .def_static(
            "_load_with_light", &load_with_light, "name_or_path"_a, py::kw_only(), "glass"_a = py::none(),
            "force"_a = false, "pbrt_thickness"_a = py::none(), "glass_catalogue"_a = py::none(),
            "Internal. Returns (lens, field angles in degrees, wavelengths in nm) of a lens file; arguments as for "
            "Lens.load.")
        .def_static("_load_with_notes", &read_lens_with_notes, "path"_a,
                    "Internal. Returns (lens, notes on values that were computed or assumed).")
        .def("_file_content", &file_content, "path"_a,
             "Internal. Returns (content of the lens file as bytes, notes on what the format cannot represent).");
}

}  // namespace realcam::bindings
