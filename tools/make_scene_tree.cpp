// SPDX-License-Identifier: MIT
// [4DR] Tree: a broad-leaved tree, four generations of branches and leaves of four triangles each.
#include <algorithm>
#include <cmath>

#include "make_scene_exhibit.h"
#include "make_scene_random.h"
#include "make_scene_scenes.h"

namespace tools {

using glm::vec3;

namespace {

constexpr size_t kTriangleCount = 367000;
constexpr int kTwig = 4;  // the generation that bears leaves; the trunk is 0

// What a generation of branches is like; lengths in metres, `sides` and `steps` of its sweeps.
struct Generation {
    int children;
    uint32_t sides;
    int steps;
    float wander;  // of the direction, per step
    float rise;    // towards the sky, per step
};
constexpr Generation kGenerations[] = {{13, 28, 26, 0.035F, 0.05F},
                                       {9, 12, 14, 0.1F, 0.055F},
                                       {7, 7, 8, 0.16F, 0.03F},
                                       {4, 5, 4, 0.22F, 0.0F},
                                       {0, 4, 3, 0.2F, -0.06F}};

struct Branch {
    vec3 foot, direction;
    float length, radius;
};

struct Twig {
    vec3 from, to;
};

struct Tree {
    Jitter jitter{20160713U};
    Mesh wood;
    std::vector<Twig> twigs;
};

// A direction at an angle to `axis`, the given turn around it.
vec3 leanFrom(const vec3& axis, float angleRad, float turnRad) {
    const vec3 helper = std::abs(axis.y) < 0.9F ? vec3(0, 1, 0) : vec3(1, 0, 0);
    const vec3 side = glm::normalize(glm::cross(axis, helper));
    const vec3 other = glm::cross(axis, side);
    const vec3 aside = std::cos(turnRad) * side + std::sin(turnRad) * other;
    return glm::normalize(std::cos(angleRad) * axis + std::sin(angleRad) * aside);
}

float radiusAt(const Branch& branch, int level, float t) {
    // The trunk spreads into its roots
    const float flare = level == 0 ? 0.75F * std::exp(-t * 13) : 0.0F;
    return branch.radius * (1 - 0.82F * t + flare);
}

std::vector<SweepRing> bend(Tree& tree, const Branch& branch, int level) {
    const Generation& kind = kGenerations[level];
    std::vector<SweepRing> rings;
    vec3 at = branch.foot, direction = branch.direction;
    for (int step = 0; step <= kind.steps; ++step) {
        const float t = static_cast<float>(step) / static_cast<float>(kind.steps);
        const float radius = radiusAt(branch, level, t);
        rings.push_back({at, radius, radius});
        const vec3 wander = kind.wander * tree.jitter.nextVector();
        direction = glm::normalize(direction + wander + vec3(0, kind.rise, 0));
        at += direction * (branch.length / static_cast<float>(kind.steps));
    }
    return rings;
}

void grow(Tree& tree, const Branch& branch, int level);

// Child i of a branch leaves it on the golden spiral; those of the trunk point up the higher they
// stand and are longest in the middle.
void growChild(Tree& tree, const Branch& branch, int level, const std::vector<SweepRing>& rings,
               int i) {
    const float share =
        (static_cast<float>(i) + 0.5F) / static_cast<float>(kGenerations[level].children);
    const float low = level == 0 ? 0.3F : 0.22F;
    const float t = low + (1 - low) * share;
    const float place = t * static_cast<float>(rings.size() - 1);
    const size_t ring = std::min(static_cast<size_t>(place), rings.size() - 2);
    const vec3 along = rings[ring + 1].centre - rings[ring].centre;
    const vec3 foot = rings[ring].centre + along * (place - static_cast<float>(ring));
    const float jitter = tree.jitter.next();
    const float leanDeg = level == 0 ? glm::mix(82.0F, 22.0F, share) : 48.0F;
    const vec3 direction = leanFrom(glm::normalize(along), glm::radians(leanDeg + 9 * jitter),
                                    2.39996F * static_cast<float>(i) + 0.7F * jitter);
    const float dome = level == 0 ? 0.66F * std::sqrt(1.12F - share) : 0.52F * (1.15F - 0.6F * t);
    grow(tree,
         {foot, direction, branch.length * dome * (1 + 0.15F * jitter),
          0.55F * radiusAt(branch, level, t)},
         level + 1);
}

void grow(Tree& tree, const Branch& branch, int level) {
    const std::vector<SweepRing> rings = bend(tree, branch, level);
    const vec3 up = std::abs(branch.direction.y) < 0.9F ? vec3(0, 1, 0) : vec3(1, 0, 0);
    append(tree.wood, makeSweep(rings, up, kGenerations[level].sides));
    if (level == kTwig) tree.twigs.push_back({rings.front().centre, rings.back().centre});
    for (int i = 0; i < kGenerations[level].children; ++i) growChild(tree, branch, level, rings, i);
}

// Two halves folded along the rib, two triangles each.
void addLeaf(Mesh& leaves, Jitter& jitter, const Twig& twig) {
    const vec3 stem = twig.from + (twig.to - twig.from) * jitter.within(0.1F, 1.05F);
    const vec3 aside = jitter.nextVector();
    const vec3 rib =
        glm::normalize(glm::normalize(twig.to - twig.from) + 1.3F * aside + vec3(0, -0.25F, 0));
    const vec3 tilt = 0.5F * jitter.nextVector();
    const vec3 across = glm::normalize(glm::cross(rib, vec3(0, 1, 0) + tilt));
    const vec3 down = glm::cross(rib, across);
    const float length = jitter.within(0.4F, 0.62F);
    const vec3 foot = stem + 0.12F * rib;
    const vec3 fold = 0.07F * length * (down.y > 0 ? -down : down);
    const auto base = static_cast<uint32_t>(leaves.positions.size());
    leaves.positions.insert(
        leaves.positions.end(),
        {foot, foot + length * (0.42F * rib + 0.27F * across) - fold,
         foot + length * (0.42F * rib - 0.27F * across) - fold, foot + 0.45F * length * rib + fold,
         foot + length * rib + 1.5F * fold});
    for (const uint32_t corner : {0, 1, 3, 0, 3, 2, 1, 4, 3, 3, 4, 2})
        leaves.indices.push_back(base + corner);
}

}  // namespace

void makeTree(GltfWriter& writer) {
    Exhibit exhibit(writer);
    Tree tree;
    grow(tree, {{0, -0.3F, 0}, {0, 1, 0}, 32, 0.95F}, 0);
    for (vec3& position : tree.wood.positions) position.y = std::max(position.y, 0.0F);
    exhibit.add("wood", withNormals(tree.wood, 60), {0.27F, 0.19F, 0.13F});
    Mesh leaves;
    const size_t leafCount = exhibit.trianglesLeft(kTriangleCount) / 4;
    for (size_t i = 0; i < leafCount; ++i)
        addLeaf(leaves, tree.jitter, tree.twigs[i % tree.twigs.size()]);
    exhibit.add("leaves", withNormals(leaves, 60), {0.2F, 0.36F, 0.1F}, 0.7F, true);
    exhibit.finish({.diagonal = 114,
                    .lightDistance = 69,
                    .towardsLight = {-0.42F, 0.9F, -0.1F},
                    .eye = {19, 56, 35},
                    .target = {8, 0, 0.5F},
                    .yfovDeg = 42,
                    .groundColour = {0.62F, 0.58F, 0.48F}});
}

}  // namespace tools
