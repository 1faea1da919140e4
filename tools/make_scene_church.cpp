// SPDX-License-Identifier: MIT
// [4DR] Church: the nave of a ruined abbey. Its vault has lost all but the ribs, so that a light
// above it reaches the floor through them and through the tracery of the windows.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "make_scene_exhibit.h"
#include "make_scene_random.h"
#include "make_scene_scenes.h"

namespace tools {

using glm::vec2;
using glm::vec3;

namespace {

constexpr size_t kTriangleCount = 240000;
constexpr int kBays = 5;
constexpr float kBay = 2.3F, kNave = 1.95F, kAisle = 3.9F;  // metres: length, half widths
constexpr float kSpring = 3.6F;                             // where arches begin
constexpr float kWestEnd = 6.2F, kEastEnd = kWestEnd - kBays * kBay - 0.6F;
constexpr uint32_t kRibSides = 8;

float bayAt(int pier) {
    return kWestEnd - kBay * static_cast<float>(pier);
}

// A vertical wall seen as a plane: where its stones are (across, height) and where none is.
struct Wall {
    vec3 origin, along;  // of across = 0, on the floor; unit
    float length;
    bool (*hasStone)(float across, float height);
};

void addWall(Mesh& mesh, Jitter& jitter, const Wall& wall) {
    constexpr float kCourse = 0.2F, kStone = 0.34F;
    const vec3 through(wall.along.z, 0, -wall.along.x);
    for (int course = 0; course < 48; ++course) {
        const float y = (static_cast<float>(course) + 0.5F) * kCourse;
        float from = course % 2 == 0 ? 0 : -0.5F * kStone;
        while (from < wall.length) {
            const float width = kStone * (1 + 0.3F * jitter.next());
            const float low = std::max(from, 0.0F);
            const float high = from + width > wall.length - 0.12F ? wall.length : from + width;
            from = high;
            const float middle = 0.5F * (low + high);
            const float bulge = 0.02F * jitter.next();
            if (high - low < 0.08F || !wall.hasStone(middle, y)) continue;
            const vec3 half = 0.5F * (high - low - 0.008F) * glm::abs(wall.along) +
                              vec3(0, 0.5F * kCourse - 0.004F, 0) +
                              (0.22F + bulge) * glm::abs(through);
            append(mesh,
                   makeBlock(wall.origin + middle * wall.along + vec3(0, y, 0), half, 0.018F));
        }
    }
}

// Inside of a pointed arch of two arcs whose radius is the span, its foot at the origin.
bool isInArch(const vec2& p, float halfSpan) {
    if (p.y < 0) return std::abs(p.x) < halfSpan;
    return glm::length(vec2(std::abs(p.x) + halfSpan, p.y)) < 2 * halfSpan;
}

// What is left of a wall's top: broken, lower to the west.
float ruinedTop(float across, float height) {
    return height + 0.55F * noiseAt({across * 0.55F, height, 3.5F}) +
           0.25F * noiseAt({across * 1.9F, height, 8.5F});
}

bool hasSideStone(float across, float height) {
    const float bay = across / kBay;
    const vec2 window((bay - std::floor(bay) - 0.5F) * kBay, height - 3.1F);
    if (height > 1.3F && isInArch(window, 0.62F)) return false;
    return height < ruinedTop(across, 5.1F);
}

bool hasEastStone(float across, float height) {
    const float x = across - kAisle;
    if (glm::length(vec2(x, height - 5.9F)) < 1.28F) return false;
    for (const float lancet : {-1.3F, 0.0F, 1.3F})
        if (height > 1.2F && isInArch({x - lancet, height - 2.9F}, 0.4F)) return false;
    const float gable = 9.2F - 0.95F * std::max(0.0F, std::abs(x) - 0.4F);
    return height < ruinedTop(across, std::min(gable, 8.6F));
}

bool hasWestStone(float across, float height) {
    return height < ruinedTop(across, 0.8F) && std::abs(across - kAisle) > 1.3F;
}

// Places on a pointed arch from `from` to `to`, both at its springing; `rise` is its height.
std::vector<vec3> makeArch(const vec3& from, const vec3& to, float rise, int steps) {
    const float half = 0.5F * glm::distance(from, to);
    // Centre of each arc lies on the springing line, `back` beyond the arch's middle
    const float back = (rise * rise - half * half) / (2 * half);
    const float radius = half + back, apex = std::atan2(rise, back);
    const vec3 middle = 0.5F * (from + to), along = (to - from) / (2 * half);
    std::vector<vec3> places;
    for (int i = -steps; i <= steps; ++i) {
        const float share = 1 - static_cast<float>(std::abs(i)) / static_cast<float>(steps);
        const float out = radius * std::cos(apex * share) - back;
        places.push_back(middle + along * (i < 0 ? -out : out) +
                         vec3(0, radius * std::sin(apex * share), 0));
    }
    return places;
}

// A moulding of three rolls, or a single roll, along places; `side` is across it.
void addMoulding(Mesh& mesh, const std::vector<vec3>& places, const vec3& side, float radius,
                 bool isSingle = false) {
    for (const float roll : {-1.0F, 0.0F, 1.0F}) {
        if (isSingle && roll != 0) continue;
        const float size = roll == 0 ? radius : 0.66F * radius;
        std::vector<SweepRing> rings;
        for (const vec3& place : places) {
            const vec3 lift(0, roll == 0 ? 0 : 0.5F * radius, 0);
            rings.push_back({place + roll * radius * side + lift, size, size});
        }
        // Into the stone at both ends, each by another length: arches share no edges
        const float into =
            radius * (0.3F + 0.05F * static_cast<float>(mesh.positions.size() % 11U));
        rings.front().centre -= into * glm::normalize(rings[1].centre - rings[0].centre);
        rings.back().centre += into * glm::normalize(rings.back().centre - rings.end()[-2].centre);
        append(mesh, makeSweep(rings, side, kRibSides));
    }
}

// A pier of four shafts around a core, between base and capital.
Mesh makePier() {
    const auto shaft = [](float radius, float height, float spread) {
        return std::vector<vec2>{{radius + spread, 0},
                                 {radius + spread, 0.18F},
                                 {radius + 0.6F * spread, 0.24F},
                                 {radius + 0.7F * spread, 0.3F},
                                 {radius, 0.4F},
                                 {radius * 0.97F, 0.5F * height},
                                 {radius, height - 0.42F},
                                 {radius + 0.3F * spread, height - 0.4F},
                                 {radius + 0.1F * spread, height - 0.34F},
                                 {radius + spread, height - 0.12F},
                                 {radius + 1.3F * spread, height - 0.1F},
                                 {radius + 1.3F * spread, height}};
    };
    Mesh pier;
    append(pier, makeLathe(shaft(0.2F, kSpring, 0.12F), 32));
    for (int i = 0; i < 4; ++i) {
        const vec3 place = yaw(90.0F * static_cast<float>(i)) * vec3(0.24F, 0, 0);
        append(pier, makeLathe(shaft(0.085F, kSpring - 0.02F, 0.06F), 18), yaw(0), place);
    }
    return pier;
}

void addPiers(Mesh& mesh) {
    const Mesh pier = makePier();
    for (int i = 0; i <= kBays; ++i)
        for (const float side : {-1.0F, 1.0F})
            append(mesh, pier, yaw(0), {side * kNave, 0, bayAt(i)});
}

// Arcades along the nave, arches across nave and aisles, and the diagonals of the vaults.
void addRibs(Mesh& mesh) {
    constexpr int kSteps = 16;
    const vec3 up(0, kSpring, 0), x(1, 0, 0), z(0, 0, 1);
    for (int i = 0; i <= kBays; ++i) {
        const vec3 left = up + vec3(-kNave, 0, bayAt(i)), right = up + vec3(kNave, 0, bayAt(i));
        addMoulding(mesh, makeArch(left, right, 3.4F, kSteps), z, 0.1F);
        for (const float side : {-1.0F, 1.0F}) {
            const vec3 pier = side < 0 ? left : right;
            const vec3 wall(side * (kAisle - 0.2F), kSpring, bayAt(i));
            addMoulding(mesh, makeArch(pier, wall, 1.35F, kSteps), z, 0.08F);
        }
        if (i == kBays) break;
        const vec3 step(0, 0, -kBay);
        for (const float side : {-1.0F, 1.0F}) {
            const vec3 pier = side < 0 ? left : right;
            addMoulding(mesh, makeArch(pier, pier + step, 1.5F, kSteps), x, 0.1F);
            const vec3 far = (side < 0 ? right : left) + step;
            addMoulding(mesh, makeArch(pier, far, 3.5F, kSteps),
                        glm::normalize(glm::cross(far - pier, vec3(0, 1, 0))), 0.075F);
        }
    }
}

// A wheel of tori with spokes, in the plane of x and y.
void addRose(Mesh& mesh, const vec3& centre, float radius) {
    const glm::quat upright = glm::angleAxis(glm::half_pi<float>(), vec3(1, 0, 0));
    append(mesh, makeTorus(radius, 0.09F, 72, 12), upright, centre);
    append(mesh, makeTorus(0.3F * radius, 0.05F, 40, 10), upright, centre);
    for (int i = 0; i < 12; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / 12;
        const vec3 out(std::cos(angle), std::sin(angle), 0);
        append(mesh, makeBar(centre + 0.3F * radius * out, centre + radius * out, 0.032F, 12));
        const float between = angle + glm::two_pi<float>() / 24;
        append(mesh, makeTorus(0.19F * radius, 0.032F, 28, 8), upright,
               centre + 0.78F * radius * vec3(std::cos(between), std::sin(between), 0));
    }
}

// The arch and the mullion of a window whose sill is at 1.3 m; `along` is its wall's direction.
void addWindow(Mesh& mesh, const vec3& sill, const vec3& along, float halfSpan, float spring) {
    const vec3 foot = sill + vec3(0, spring - sill.y, 0), side = halfSpan * along;
    const vec3 through(along.z, 0, -along.x);
    std::vector<vec3> frame = makeArch(foot - side, foot + side, 1.732F * halfSpan, 12);
    frame.insert(frame.begin(), sill - side);
    frame.push_back(sill + side);
    addMoulding(mesh, frame, through, 0.07F);
    const vec3 head = foot + vec3(0, 0.1F, 0);
    append(mesh, makeBar(sill, head, 0.04F, 12));
    for (const float part : {-0.5F, 0.5F}) {
        const vec3 middle = head + part * side * 2.0F * 0.5F;
        addMoulding(mesh, makeArch(middle - 0.5F * side, middle + 0.5F * side, 0.75F * halfSpan, 8),
                    through, 0.035F, true);
    }
    // Iron bars that held the glass
    for (int bar = 1; bar < 5; ++bar) {
        const vec3 at = sill + vec3(0, (foot.y - sill.y) * static_cast<float>(bar) / 5, 0);
        append(mesh, makeBar(at - side, at + side, 0.013F, 8));
    }
}

void addWindows(Mesh& mesh) {
    for (int i = 0; i < kBays; ++i)
        for (const float side : {-1.0F, 1.0F})
            addWindow(mesh, {side * kAisle, 1.3F, bayAt(i) - 0.5F * kBay}, {0, 0, 1}, 0.62F, 3.1F);
    for (const float lancet : {-1.3F, 0.0F, 1.3F})
        addWindow(mesh, {lancet, 1.2F, kEastEnd}, {1, 0, 0}, 0.4F, 2.9F);
    addRose(mesh, {0, 5.9F, kEastEnd}, 1.27F);
}

void addPews(Mesh& mesh) {
    for (int row = 0; row < 6; ++row) {
        const float z = 1.2F - 0.85F * static_cast<float>(row);
        for (const float side : {-1.0F, 1.0F}) {
            const float x = side * 1.0F;
            append(mesh, makeBlock({x, 0.3F, z}, {0.58F, 0.02F, 0.15F}, 0.006F));
            append(mesh, makeBlock({x, 0.52F, z + 0.17F}, {0.58F, 0.13F, 0.015F}, 0.006F));
            for (const float end : {-1.0F, 1.0F})
                append(mesh, makeBlock({x + 0.59F * end, 0.33F, z + 0.03F}, {0.025F, 0.33F, 0.19F},
                                       0.008F));
        }
    }
}

// Fallen stones, as many as the number of triangles leaves.
void addRubble(Mesh& mesh, Jitter& jitter, size_t triangleCount) {
    for (size_t i = 0; i < triangleCount / 44; ++i) {
        const float size = 0.05F + 0.09F * std::abs(jitter.next());
        const float side = i % 2 == 0 ? 1.0F : -1.0F;
        const float x = side * jitter.within(2.1F, 3.6F),
                    z = jitter.within(kEastEnd + 0.4F, kWestEnd);
        const vec3 half = size * (vec3(1) + 0.4F * jitter.nextVector());
        const glm::quat turn = glm::normalize(glm::quat(1, 0.25F * jitter.nextVector()));
        append(mesh, makeBlock(vec3(0), half, 0.2F * size), turn, {x, 0.8F * half.y, z});
    }
}

}  // namespace

void makeChurch(GltfWriter& writer) {
    Exhibit exhibit(writer);
    Jitter jitter(1539U);
    Mesh walls, ribs, pews, rubble;
    const float length = kWestEnd - kEastEnd;
    for (const float side : {-1.0F, 1.0F})
        addWall(walls, jitter, {{side * kAisle, 0, kWestEnd}, {0, 0, -1}, length, hasSideStone});
    addWall(walls, jitter, {{-kAisle, 0, kEastEnd}, {1, 0, 0}, 2 * kAisle, hasEastStone});
    addWall(walls, jitter, {{-kAisle, 0, kWestEnd}, {1, 0, 0}, 2 * kAisle, hasWestStone});
    exhibit.add("walls", withNormals(walls, 20), {0.6F, 0.54F, 0.44F});
    addPiers(ribs);
    addRibs(ribs);
    addWindows(ribs);
    exhibit.add("ribs", withNormals(ribs, 50), {0.66F, 0.62F, 0.54F});
    addPews(pews);
    exhibit.add("pews", withNormals(pews, 20), {0.3F, 0.19F, 0.11F}, 0.7F);
    addRubble(rubble, jitter, exhibit.trianglesLeft(kTriangleCount));
    exhibit.add("rubble", withNormals(rubble, 20), {0.56F, 0.51F, 0.42F});
    exhibit.finish({.diagonal = 22,
                    .lightDistance = 47,
                    .towardsLight = {0.36F, 0.88F, 0.28F},
                    .eye = {0.3F, 4.7F, 6.7F},
                    .target = {-0.1F, 2.3F, 0},
                    .yfovDeg = 60,
                    .groundColour = {0.58F, 0.56F, 0.52F}});
}

}  // namespace tools
