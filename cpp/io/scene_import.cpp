#include "scene_import.hpp"

#include <assimp/postprocess.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/LogStream.hpp>
#include <cctype>
#include <cmath>
#include <fstream>
#include <mutex>
#include <sstream>

#include "../error.hpp"
#include "obj_numbers.hpp"

namespace realcam::io {
namespace {

std::string one_line(std::string text) {
    std::replace_if(text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    return text;
}

class Collector final : public Assimp::LogStream {
public:
    explicit Collector(std::vector<std::string>& lines) : lines_(lines) {}
    void write(const char* message) override {
        std::string text = one_line(message);
        // "Warn,  T0: text"
        if (const auto prefix = text.find(": "); prefix != std::string::npos && prefix < 16) text.erase(0, prefix + 2);
        // Steps on the way to the next thing that it tries.
        if (text.find("fallback material") != std::string::npos ||
            text.find("No object detected") != std::string::npos) {
            return;
        }
        if (std::find(lines_.begin(), lines_.end(), text) == lines_.end()) lines_.push_back(std::move(text));
    }

private:
    std::vector<std::string>& lines_;
};

// assimp tells only its log, which is one for the whole process, that it left something out. A log that another part
// of the process has set up stays as it is.
class LogCapture {
public:
    explicit LogCapture(std::vector<std::string>& lines)
        : only_one_(mutex()), collector_(lines), created_(Assimp::DefaultLogger::isNullLogger()) {
        if (created_) Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
        Assimp::DefaultLogger::get()->attachStream(&collector_, severity);
    }
    LogCapture(const LogCapture&) = delete;
    LogCapture& operator=(const LogCapture&) = delete;
    ~LogCapture() {
        Assimp::DefaultLogger::get()->detachStream(&collector_, severity);
        if (created_) Assimp::DefaultLogger::kill();
    }

private:
    static constexpr unsigned severity = Assimp::Logger::Warn | Assimp::Logger::Err;
    static std::mutex& mutex() {
        static std::mutex the_one;
        return the_one;
    }
    std::lock_guard<std::mutex> only_one_;
    Collector collector_;
    bool created_;
};

// assimp numbers the vertices of an OBJ anew, so the line is the only number of the file that can be told.
std::string obj_line_of_bad_vertex(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
        std::istringstream words(line);
        std::string word;
        if (!(words >> word) || word != "v") continue;
        for (int i = 0; i < 3 && (words >> word); ++i) {
            if (!std::isfinite(std::strtod(word.c_str(), nullptr)) ||
                !std::isfinite(std::strtof(word.c_str(), nullptr))) {
                return "line " + std::to_string(number) + ": ";
            }
        }
    }
    return {};
}

}  // namespace

std::string mesh_label(const aiScene& content, unsigned index) {
    const aiString& name = content.mMeshes[index]->mName;
    std::string label = "mesh " + std::to_string(index);
    if (name.length > 0) label += " \"" + std::string(name.C_Str()) + "\"";
    return label;
}

ImportedScene::ImportedScene(const std::string& path, SceneFormat format) : format_(format) {
    if (format_ == SceneFormat::gltf) gltf_.emplace(path);
    if (format_ == SceneFormat::obj) mend_obj_numbers(importer_, path);
    {
        const LogCapture capture(complaints_);
        if (!importer_.ReadFile(path, 0)) {
            std::string why = one_line(importer_.GetErrorString());
            // It drops those with an index out of range, and then misses them.
            if (why.ends_with("has no faces")) why += " with all indices smaller than its number of vertices";
            throw SceneFileError(path + ": cannot be read" + (why.empty() ? "" : ": " + why));
        }
    }
    if (gltf_) gltf_->match(content());
    check_meshes(path);
    // Only now: it follows indices without a look.
    importer_.ApplyPostProcessing(aiProcess_Triangulate);
    if (!importer_.GetScene()) throw SceneFileError(path + ": its polygons cannot be cut into triangles");
}

void ImportedScene::check_meshes(const std::string& path) const {
    const aiScene& scene = content();
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D& p = mesh.mVertices[v];
            if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
            std::string where = format_ == SceneFormat::obj ? obj_line_of_bad_vertex(path) : std::string();
            if (where.empty()) where = mesh_label(scene, m) + ": vertex " + std::to_string(v) + ": ";
            std::ostringstream value;
            value << '(' << p.x << ", " << p.y << ", " << p.z << ')';
            throw SceneFileError(path + ": " + where + "coordinates must be finite numbers, not " + value.str());
        }
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            for (unsigned i = 0; i < face.mNumIndices; ++i) {
                if (face.mIndices[i] < mesh.mNumVertices) continue;
                throw SceneFileError(path + ": " + mesh_label(scene, m) + ": face " + std::to_string(f) + ": index " +
                                     std::to_string(face.mIndices[i]) +
                                     " is not smaller than the number of vertices, " +
                                     std::to_string(mesh.mNumVertices));
            }
        }
        if (mesh.mMaterialIndex >= scene.mNumMaterials) {
            throw SceneFileError(path + ": " + mesh_label(scene, m) + ": its material does not exist");
        }
    }
}

}  // namespace realcam::io
