// SPDX-License-Identifier: MIT
// [4DR] Tower: four legs that meet in a spire, of girders that are lattices themselves.
#include <algorithm>
#include <cmath>

#include "make_scene_exhibit.h"
#include "make_scene_scenes.h"

namespace tools {

using glm::vec3;

namespace {

constexpr float kHeight = 30, kFirstFloor = 5.6F, kSecondFloor = 11;  // metres
constexpr float kPanel = 0.1255F;  // of a girder's bracing, metres; gives the number of triangles

// From the axis to the outer corner of a leg.
float outerAt(float y) {
    return 0.3F + 6.2F * std::exp(-y / 6.6F);
}

// From the axis to the inner corner of a leg; the legs meet at the second floor.
float innerAt(float y) {
    return std::max(0.0F, outerAt(y) * 0.56F * (1 - y / kSecondFloor));
}

void addBar(Mesh& mesh, const vec3& from, const vec3& to, float radius) {
    addStrut(mesh, from, to, radius, 4);
}

int panelsOf(const vec3& from, const vec3& to) {
    return std::max(2, static_cast<int>(std::lround(glm::distance(from, to) / kPanel)));
}

// A square lattice beam: four chords, each face a zigzag.
void addGirder(Mesh& mesh, const vec3& from, const vec3& to, float halfWidth) {
    const vec3 along = glm::normalize(to - from);
    const vec3 u = glm::normalize(glm::cross(along, vec3(0.31F, 0.2F, 0.93F)));
    const vec3 v = glm::cross(along, u);
    const vec3 corners[] = {halfWidth * (u + v), halfWidth * (v - u), -halfWidth * (u + v),
                            halfWidth * (u - v)};
    for (const vec3& corner : corners) addBar(mesh, from + corner, to + corner, 0.26F * halfWidth);
    const int panels = panelsOf(from, to);
    for (int panel = 0; panel < panels; ++panel) {
        const auto count = static_cast<float>(panels);
        const vec3 low = glm::mix(from, to, static_cast<float>(panel) / count);
        const vec3 high = glm::mix(from, to, static_cast<float>(panel + 1) / count);
        for (int side = 0; side < 4; ++side) {
            const vec3 &a = corners[side], &b = corners[(side + 1) % 4];
            addBar(mesh, low + a, high + b, 0.14F * halfWidth);
            addBar(mesh, low + b, high + a, 0.14F * halfWidth);
        }
    }
}

// A flat lattice beam in the plane of `along` and `across`: two chords and a zigzag.
void addBrace(Mesh& mesh, const vec3& from, const vec3& to, const vec3& normal, float halfWidth) {
    const vec3 across = halfWidth * glm::normalize(glm::cross(to - from, normal));
    addBar(mesh, from + across, to + across, 0.3F * halfWidth);
    addBar(mesh, from - across, to - across, 0.3F * halfWidth);
    const int panels = panelsOf(from, to);
    for (int panel = 0; panel < panels; ++panel) {
        const auto count = static_cast<float>(panels);
        const float side = panel % 2 == 0 ? 1.0F : -1.0F;
        addBar(mesh, glm::mix(from, to, static_cast<float>(panel) / count) + side * across,
               glm::mix(from, to, static_cast<float>(panel + 1) / count) - side * across,
               0.2F * halfWidth);
    }
}

// One storey of a shaft with four corners: chords, crossed braces and a ring at the top.
void addStorey(Mesh& mesh, const vec3 (&low)[4], const vec3 (&high)[4], float halfWidth) {
    for (int side = 0; side < 4; ++side) {
        const int next = (side + 1) % 4;
        addGirder(mesh, low[side], high[side], halfWidth);
        const vec3 normal = glm::cross(low[next] - low[side], high[side] - low[side]);
        addBrace(mesh, low[side], high[next], normal, 0.6F * halfWidth);
        addBrace(mesh, low[next], high[side], normal, 0.6F * halfWidth);
        addBrace(mesh, high[side], high[next], normal, 0.6F * halfWidth);
    }
}

// Corners of the leg in quadrant (sx, sz) at a height; with an inner side of 0 and all four
// quadrants as one, the spire's.
void cornersOf(float y, float sx, float sz, bool isSpire, vec3 (&corners)[4]) {
    const float outer = outerAt(y), inner = isSpire ? -outer : innerAt(y);
    const float xs[] = {inner, outer, outer, inner}, zs[] = {inner, inner, outer, outer};
    for (int i = 0; i < 4; ++i) corners[i] = vec3(sx * xs[i], y, sz * zs[i]);
}

void addLegs(Mesh& mesh) {
    for (const vec3& quadrant : {vec3(1, 0, 1), vec3(1, 0, -1), vec3(-1, 0, 1), vec3(-1, 0, -1)}) {
        constexpr int kStoreys = 10;
        for (int storey = 0; storey < kStoreys; ++storey) {
            const float step = (kSecondFloor - 0.4F) / kStoreys;
            const float y = step * static_cast<float>(storey);
            vec3 low[4], high[4];
            cornersOf(y, quadrant.x, quadrant.z, false, low);
            cornersOf(y + step, quadrant.x, quadrant.z, false, high);
            addStorey(mesh, low, high, 0.07F - 0.003F * static_cast<float>(storey));
        }
    }
}

void addSpire(Mesh& mesh) {
    // Storeys as high as wide
    for (float y = kSecondFloor; y < kHeight - 1.8F;) {
        const float step = std::max(0.75F, 1.1F * outerAt(y));
        vec3 low[4], high[4];
        cornersOf(y, 1, 1, true, low);
        cornersOf(y + step, 1, 1, true, high);
        addStorey(mesh, low, high, 0.05F);
        y += step;
    }
    append(mesh, makeBox({0, kHeight - 1.5F, 0}, {0.55F, 0.1F, 0.55F}));
    addGirder(mesh, {0, kHeight - 1.4F, 0}, {0, kHeight, 0}, 0.05F);
}

// A platform of joists with its railing.
void addPlatform(Mesh& mesh, float y, float half) {
    const float hole = 0.6F * half;
    for (int side = 0; side < 4; ++side) {
        const vec3 out = side % 2 == 0 ? vec3(side - 1, 0, 0) : vec3(0, 0, side - 2);
        const vec3 along(out.z, 0, -out.x);
        const vec3 foot = half * out + vec3(0, y + 0.08F, 0);
        const vec3 rail(0, 0.32F, 0);
        addBar(mesh, foot + rail - half * along, foot + rail + half * along, 0.025F);
        for (int joist = 0; joist < 8; ++joist) {
            const float in = glm::mix(hole, half, static_cast<float>(joist) / 7) - half;
            const vec3 middle = half * out + vec3(0, y, 0) + in * out;
            append(mesh, makeBox(middle, 0.07F * glm::abs(out) + vec3(0, 0.07F, 0) +
                                             (half + in) * glm::abs(along)));
        }
        const int posts = static_cast<int>(half / 0.09F);
        for (int post = 0; post < posts; ++post) {
            const float t = 2 * (static_cast<float>(post) + 0.5F) / static_cast<float>(posts) - 1;
            addBar(mesh, foot + t * half * along, foot + t * half * along + rail, 0.012F);
        }
    }
}

// The arch between two legs below the first floor, in the plane of their outer faces.
void addArches(Mesh& mesh) {
    constexpr int kSteps = 26;
    for (int side = 0; side < 4; ++side) {
        const vec3 out = side % 2 == 0 ? vec3(side - 1, 0, 0) : vec3(0, 0, side - 2);
        const vec3 along(out.z, 0, -out.x);
        const auto at = [&](int step, float grow) {
            const float angle = glm::radians(180.0F) * static_cast<float>(step) / kSteps;
            const float y = 1.2F + (3.5F + grow) * std::sin(angle);
            return outerAt(y) * out + (3.05F + grow) * std::cos(angle) * along + vec3(0, y, 0);
        };
        for (int step = 0; step < kSteps; ++step) {
            addBar(mesh, at(step, 0), at(step + 1, 0), 0.05F);
            addBar(mesh, at(step, 0.45F), at(step + 1, 0.45F), 0.05F);
            addBar(mesh, at(step, 0), at(step + 1, 0.45F), 0.025F);
            addBar(mesh, at(step, 0.45F), at(step + 1, 0), 0.025F);
        }
    }
}

}  // namespace

void makeTower(GltfWriter& writer) {
    Exhibit exhibit(writer);
    Mesh iron, stone;
    addLegs(iron);
    addSpire(iron);
    addArches(iron);
    addPlatform(iron, kFirstFloor, outerAt(kFirstFloor) + 0.5F);
    addPlatform(iron, kSecondFloor, outerAt(kSecondFloor) + 0.4F);
    for (const float x : {-1.0F, 1.0F})
        for (const float z : {-1.0F, 1.0F})
            append(stone, makeBox({5.05F * x, 0.15F, 5.05F * z}, {1.75F, 0.15F, 1.75F}));
    exhibit.add("iron", withNormals(iron, 40), {0.34F, 0.25F, 0.2F}, 0.6F);
    exhibit.add("stone", withNormals(stone, 40), {0.6F, 0.57F, 0.52F});
    exhibit.finish({.diagonal = 54,
                    .lightDistance = 50,
                    .towardsLight = {-0.3F, 0.9F, -0.25F},
                    .eye = {7, 36, 22},
                    .target = {3.2F, 1, 1.8F},
                    .yfovDeg = 32,
                    .groundColour = {0.62F, 0.6F, 0.56F}});
}

}  // namespace tools
