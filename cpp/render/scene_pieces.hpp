#pragma once
#include <array>
#include <vector>

#include "../scene/bounding_box.hpp"

namespace REALCAM_NAMESPACE {

/// A triangle as it stands in the scene; or, where instances have too many, an instance.
struct Piece {
    BoundingBox box;
    Vec3d area;  ///< of a triangle: along its normal, m^2; of an instance zero
    bool emits;
};

/// Some of the pieces, by their numbers.
using ChosenPieces = std::vector<bool>;

/// What a scene consists of, for questions about its whole.
class ScenePieces {
public:
    explicit ScenePieces(const Assembly& assembly);

    std::size_t count() const;

    /// f(number, piece) for those whose number is wanted(number), always in the same order.
    template <class Wanted, class F>
    void for_each(Wanted&& wanted, F&& f) const {
        std::size_t number = 0;
        for_triangles(*assembly_.static_geometry, [](Vec3d p) { return p; }, number, wanted, f);
        for (std::size_t i = 0; i < assembly_.instances.size(); ++i) {
            const Instance& instance = assembly_.instances[i];
            if (every_) {
                const auto placed = [&](Vec3d p) { return instance.scene_from_object.point(p); };
                for_triangles(*instance.object, placed, number, wanted, f);
            } else {
                if (wanted(number)) f(number, Piece{boxes_[i], {0, 0, 0}, false});
                ++number;
            }
        }
    }

    /// f(number, piece) for the chosen ones.
    template <class F>
    void for_chosen(const ChosenPieces& chosen, F&& f) const {
        for_each([&](std::size_t i) { return chosen[i]; }, f);
    }

private:
    template <class Placed, class Wanted, class F>
    static void for_triangles(const Scene& scene, Placed&& placed, std::size_t& number, Wanted& wanted, F& f) {
        for (const Triangle& t : scene.triangles) {
            const std::size_t own = number++;
            if (!wanted(own)) continue;
            const Vec3d a = placed(scene.positions_m[t.vertices[0]]), b = placed(scene.positions_m[t.vertices[1]]),
                        c = placed(scene.positions_m[t.vertices[2]]);
            const bool emits = !scene.materials.empty() && scene.materials[t.material].emits();
            Piece piece{{a, a}, 0.5 * cross(b - a, c - a), emits};
            piece.box.add(b);
            piece.box.add(c);
            f(own, piece);
        }
    }

    const Assembly& assembly_;
    bool every_;
    std::vector<BoundingBox> boxes_;  ///< of the instances, where they count as one piece each
};

/// The coordinates, to be counted through.
inline std::array<double, 3> numbers(Vec3d v) {
    return {v.x, v.y, v.z};
}

}  // namespace REALCAM_NAMESPACE
