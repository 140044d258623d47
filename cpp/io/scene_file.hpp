#pragma once
// Scenes from files: OBJ with MTL, glTF 2.0 (.gltf, .glb) and PLY.

#include <string>
#include <vector>

#include "../keep_going.hpp"
#include "../scene/assembly.hpp"
#include "scene/decoded_image.hpp"

namespace realcam::io {

struct SceneFileOptions {
    double scale = 1.0;  ///< metres per unit of the file
    std::vector<std::string> objects = {};  ///< names of nodes that become instances, each with all below it;
                                            ///< of nodes of one name the second is NAME.2, the third NAME.3
    /// Asked some fifty times a second, on the thread that reads; where it returns false, reading ends with Cancelled.
    KeepGoing keep_going = {};
};

/// Reads a scene; the suffix picks the format. Throws SceneFileError if the file cannot be used, InputError for a
/// scale that makes no sense, Cancelled. What could be put up with is in Scene::warnings, at most 50 lines.
///
/// Only regular files are read, and what a file promises is held against its size, and against the memory that is free,
/// before memory is taken for it.
///
/// Geometry: nodes are flattened, transforms applied in double precision; mirrored ones keep outward faces outward.
/// Named nodes become instances, several of one name "car", "car.2"; so do meshes whose copies would take a million
/// triangles or more. Nodes of an OBJ are what follows a line "o" or "g". Coordinates in a mesh of a glTF are floats:
/// put far-away objects under a translated node. Skins and morph targets have the pose and weights of the file.
/// Polygons of an OBJ may be concave. Triangles without area are dropped. glTF meshes without normals are flat, as that
/// format demands. An OBJ that has smoothing groups is smooth within them and flat elsewhere. Others and PLY get smooth
/// normals where faces share positions and meet at less than 45 degrees.
///
/// Materials are taken as they are: an MTL's of all its models of illumination, and glTF's metallic-roughness model
/// with the extensions in io/scene/gltf_material.hpp. MTL's Ke, and emissiveFactor times
/// KHR_materials_emissive_strength, are radiance in cd/m^2. What is not modelled is named in Scene::warnings.
///
/// Colours of vertices multiply those of materials: linear in glTF, sRGB codes in OBJ and PLY (docs/scenes.md).
///
/// Lights: KHR_lights_punctual, candela and lux. Cameras of a glTF are Assembly::cameras.
///
/// `scale` applies to lengths alone; light keeps its units.
Assembly read_scene(const std::string& path, const SceneFileOptions& options, const ImageReader& read_image);

}  // namespace realcam::io
