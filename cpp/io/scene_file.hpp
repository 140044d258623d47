#pragma once
// Reads scenes from files: OBJ with MTL, glTF 2.0 (.gltf, .glb), PLY and, by the Python package, stages of USD.

#include <string>
#include <vector>

#include "../checkpoint.hpp"
#include "../scene/assembly.hpp"
#include "scene/decoded_image.hpp"

namespace realcam::io {

/// Options of read_scene.
struct SceneFileOptions {
    double scale = 1.0;  ///< metres per unit of the file
    std::vector<std::string> objects = {};  ///< names of nodes that become instances, with their descendants;
                                            ///< several nodes of one name become NAME, NAME.2, NAME.3
    /// Called about fifty times a second, on the reading thread; if it returns false, reading ends with Cancelled.
    KeepGoing keep_going = {};
    /// Variants of a USD stage, as its paths write them: "/Chair{color=red}".
    std::vector<std::string> variants = {};
    std::string scene_name = {};  ///< name or index of a scene in a glTF file; empty: the file's own
};

/// Reads a scene; the suffix selects the format. Throws SceneFileError if the file cannot be used, InputError for an
/// invalid scale, and Cancelled. Errors that can be corrected are listed in Scene::warnings,
/// at most 50 lines. `read_image` decodes the textures.
///
/// Only regular files are read, and counts in a file are checked against its size and against the free memory before
/// memory is allocated for them.
///
/// Geometry: nodes are flattened, transforms applied in double precision; under mirroring transforms, outward faces
/// remain outward.
/// Named nodes become instances, several of one name "car", "car.2"; so do meshes whose copies would take a million
/// triangles or more. Nodes of an OBJ are the faces after a line "o" or "g". Coordinates in a mesh of a glTF are
/// floats: far-away objects should be placed by a translated node. Skins and morph targets follow
/// the file's animations (Scene::deformation). Polygons of an OBJ may be concave. Triangles without area are
/// dropped. glTF meshes without normals are flat, as that format requires. An OBJ with smoothing groups has smooth
/// normals within them and flat ones elsewhere. Other OBJ and PLY files get smooth normals where faces share positions
/// and meet at less than 45 degrees.
///
/// Materials: all illumination models of MTL, and glTF's metallic-roughness model with the extensions in
/// io/scene/gltf_material.hpp. MTL's Ke, and emissiveFactor times KHR_materials_emissive_strength, are radiance in
/// cd/m^2. Properties that are not modelled are named in Scene::warnings.
///
/// Vertex colours multiply the materials' colours: linear in glTF, sRGB values in OBJ and PLY (docs/scenes.md).
///
/// Lights: KHR_lights_punctual, candela and lux. Cameras of a glTF are Assembly::cameras.
///
/// `scale` applies to lengths alone; photometric quantities keep their values.
Assembly read_scene(const std::string& path, const SceneFileOptions& options, const ImageReader& read_image);

/// read_scene for the bytes of a .glb. `path`: names the scene in messages. `warnings`: of the caller, without the
/// path; they precede those of the reader.
Assembly read_glb(const std::string& path, std::string glb, std::vector<std::string> warnings,
                  const SceneFileOptions& options, const ImageReader& read_image);

}  // namespace realcam::io
