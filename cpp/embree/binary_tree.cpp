// Builds the binary BVH of bvh/binary_tree.hpp with Embree's BVH builder: one box per leaf.
#include "../bvh/binary_tree.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <memory>
#include <string>
#include <vector>

#include "../error.hpp"
#include "embree_api.hpp"

namespace realcam {
namespace {

/// Throws the DeviceError for an error of the builder.
[[noreturn]] void fail(RTCError code) {
    if (code == RTC_ERROR_OUT_OF_MEMORY) throw DeviceError("Embree ran out of memory while it built the scene's BVH");
    throw DeviceError("Embree could not build the scene's BVH (error " + std::to_string(code) + ")");
}

/// Returns the boxes as Embree's builder reads them; a primitive's id is the index of its box.
std::vector<RTCBuildPrimitive> primitives_of(std::size_t count, const BoxOf& box_of) {
    std::vector<RTCBuildPrimitive> primitives(count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const auto index = static_cast<std::uint32_t>(i);
            const Box box = box_of(index);
            primitives[i] = {box.lower.x, box.lower.y, box.lower.z, 0, box.upper.x, box.upper.y, box.upper.z, index};
        }
    });
    return primitives;
}

// Callbacks of the builder. Nodes are allocated in memory of the BVH object.

void* create_inner(RTCThreadLocalAllocator allocator, unsigned, void*) {
    auto* node = new (rtcThreadLocalAlloc(allocator, sizeof(InnerNode), 16)) InnerNode;
    node->triangles = 0;  // not a leaf
    node->parent = nullptr;
    return node;
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* p, std::size_t, void*) {
    const Box box = {{p->lower_x, p->lower_y, p->lower_z}, {p->upper_x, p->upper_y, p->upper_z}};
    return new (rtcThreadLocalAlloc(allocator, sizeof(BinaryNode), 16)) BinaryNode{box, 1, p->primID, nullptr};
}

void set_children(void* node, void** children, unsigned, void*) {
    for (int i = 0; i < 2; ++i) static_cast<InnerNode*>(node)->child[i] = static_cast<BinaryNode*>(children[i]);
}

/// Returns false to stop the builder.
bool continues(void* keep_going, double) {
    return (*static_cast<const KeepGoing*>(keep_going))();
}

/// The boxes of inner nodes are computed later, by measure() in bvh/binary_tree.hpp.
void set_bounds(void*, const RTCBounds**, unsigned, void*) {}

}  // namespace

/// Embree objects that own the memory of the nodes.
struct BinaryTree::Memory {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCBVH bvh = device ? rtcNewBVH(device) : nullptr;

    Memory() = default;
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    ~Memory() {
        if (bvh) rtcReleaseBVH(bvh);
        if (device) rtcReleaseDevice(device);
    }
};

BinaryTree::BinaryTree(std::size_t triangles, const BoxOf& box_of, const KeepGoing& keep_going) {
    auto memory = std::make_unique<Memory>();
    if (!memory->bvh) fail(rtcGetDeviceError(memory->device));
    std::vector<RTCBuildPrimitive> primitives = primitives_of(triangles, box_of);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.bvh = memory->bvh;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.maxLeafSize = 1;
    arguments.maxDepth = 1024;  // chains of nodes are flattened later, by balance()
    arguments.createNode = create_inner;
    arguments.createLeaf = create_leaf;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.userPtr = const_cast<KeepGoing*>(&keep_going);
    if (keep_going) arguments.buildProgress = continues;
    root_ = static_cast<BinaryNode*>(rtcBuildBVH(&arguments));
    if (keep_going && !keep_going()) throw Cancelled();
    if (!root_) fail(rtcGetDeviceError(memory->device));
    memory_ = memory.release();
}

BinaryTree::~BinaryTree() {
    delete memory_;
}

}  // namespace realcam
