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

/// Reads the lens of a file with notes on computed or assumed values. Releases the GIL; Ctrl-C interrupts it.
std::pair<LensSystem, std::vector<std::string>> read_unlocked(const std::string& path, io::LensReadOptions options) {
    std::vector<std::string> notes;
    options.warn = [&](const std::string& note) { notes.push_back(note); };
    options.keep_going = heed_signals;
    const Unlocked unlocked;
    LensSystem lens = io::read_lens(path, options);
    return {std::move(lens), std::move(notes)};
}

/// Returns the lens, and the field angles in degrees and wavelengths in nm that a file of another program specifies.
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
        for (const auto& [called, material] : *glass) options.glasses.insert_or_assign(called, glass_from(material));
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

/// Returns the content of a file for the lens, and notes on properties that the format of that suffix cannot represent.
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
    m.def("lens_names", &io::lens_names, "Names of the bundled lenses.");
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def_static(
            "load", &load_lens, "name_or_path"_a, py::kw_only(), "glass"_a = py::none(), "force"_a = false,
            "pbrt_thickness"_a = py::none(), "glass_catalogue"_a = py::none(),
            R"(A bundled lens or one in the folders of REALCAM_LENS_PATH by name, or a lens file by path. The suffix says of which program: .zmx (Zemax), .seq
(CODE V), .len (OSLO), .dat (pbrt), .json (Optiland), .roa (ray-optics); else it is realcam's own, TOML.
glass: {name in the file: (n_d, V_d), "schott:F4", or what else Surface() takes}, for glasses that no
catalogue has, or several. force: leaves out what realcam has no model of, with a UserWarning.
glass_catalogue: a path of a catalogue (.agf), or several; its glasses come before the bundled ones.
pbrt_thickness: "after" or "before" the surface of its row; None: the first row tells.
Raises LensFileError with file, line and surface, and InputError where glass names one that the
file does not have. What a file leaves out and is computed or assumed is a UserWarning.)")
        .def("save", &save_lens, "path"_a,
             R"(Writes a lens file by its suffix: .toml, from which Lens.load makes an equal lens; .zmx, .seq, .json
(Optiland) or .roa (ray-optics), with a UserWarning for all that these cannot say; .osl, a camera of Blender
5. Raises InputError, also for a lens that OSL cannot express, and ImageFileError where no file can be
made.)")
        .def_static("_load_with_light", &load_with_light, "name_or_path"_a, py::kw_only(), "glass"_a = py::none(),
                    "force"_a = false, "pbrt_thickness"_a = py::none(), "glass_catalogue"_a = py::none())
        .def_static("_load_with_notes", &read_lens_with_notes, "path"_a)
        .def("_file_content", &file_content, "path"_a);
}

}  // namespace realcam::bindings
