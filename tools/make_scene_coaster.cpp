// SPDX-License-Identifier: MIT
// [4DR] Coaster: a closed track of two winding turns on a trestle of posts and crossed braces, with
// a train.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "make_scene_exhibit.h"
#include "make_scene_scenes.h"

namespace tools {

using glm::vec3;

namespace {

constexpr size_t kTriangleCount = 1096000;
constexpr float kGauge = 0.22F;  // half of the distance between the rails, metres
constexpr uint32_t kRailSides = 12;

// The middle of the track, u in 0 .. 1. It winds twice around the origin and crosses itself with
// more than five metres between.
vec3 trackAt(float u) {
    const float t = 2 * glm::two_pi<float>() * u;
    const float radius = 5.7F + 2.1F * std::cos(0.5F * t) + 0.35F * std::sin(3 * t);
    const float y = 3.45F + 1.4F * std::sin(1.5F * t) - 1.2F * std::sin(2.5F * t);
    return {radius * std::sin(t), y, radius * std::cos(t)};
}

struct TrackFrame {
    vec3 at, along, side, up;
};

TrackFrame frameAt(float u) {
    constexpr float kStep = 0.0005F;
    const vec3 before = trackAt(u - kStep), at = trackAt(u), after = trackAt(u + kStep);
    const vec3 along = glm::normalize(after - before);
    // Banked into the curve, as far as its acceleration asks for
    const vec3 bend = (after - 2.0F * at + before) / (kStep * kStep);
    const vec3 lean = vec3(0, 1, 0) + 0.00022F * vec3(bend.x, 0, bend.z);
    const vec3 side = glm::normalize(glm::cross(along, lean));
    return {at, along, side, glm::cross(side, along)};
}

// Values of u that are equally far apart along the track.
std::vector<float> stationsOf(int count) {
    constexpr int kFine = 20000;
    std::vector<float> lengths = {0};
    for (int i = 1; i <= kFine; ++i) {
        const float u = static_cast<float>(i) / kFine;
        lengths.push_back(lengths.back() + glm::distance(trackAt(u), trackAt(u - 1.0F / kFine)));
    }
    std::vector<float> stations;
    for (int i = 0; i < count; ++i) {
        const float wanted = lengths.back() * static_cast<float>(i) / static_cast<float>(count);
        const auto found = std::upper_bound(lengths.begin(), lengths.end(), wanted);
        const float past = static_cast<float>(found - lengths.begin()) - 1;
        const float share = (wanted - *(found - 1)) / (*found - *(found - 1));
        stations.push_back((past + share) / kFine);
    }
    return stations;
}

// A closed tube at an offset (to the side, up) from the track.
void addRail(Mesh& mesh, const std::vector<float>& stations, const glm::vec2& offset,
             float radius) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    const auto count = static_cast<uint32_t>(stations.size()) * kRailSides;
    for (const float u : stations) {
        const TrackFrame f = frameAt(u);
        for (uint32_t side = 0; side < kRailSides; ++side) {
            const float angle = glm::two_pi<float>() * static_cast<float>(side) / kRailSides;
            mesh.positions.push_back(f.at + f.side * (offset.x + radius * std::cos(angle)) +
                                     f.up * (offset.y + radius * std::sin(angle)));
        }
    }
    for (uint32_t ring = 0; ring < count; ring += kRailSides) {
        const uint32_t ahead = (ring + kRailSides) % count;
        for (uint32_t side = 0; side < kRailSides; ++side) {
            const uint32_t next = (side + 1) % kRailSides;
            for (const uint32_t corner :
                 {ring + side, ahead + next, ring + next, ring + side, ahead + side, ahead + next})
                mesh.indices.push_back(base + corner);
        }
    }
}

void addBar(Mesh& mesh, const vec3& from, const vec3& to, float radius) {
    addStrut(mesh, from, to, radius, 12);
}

// Sleepers, and on every third a walkway's railing to either side.
void addSleepers(Mesh& mesh, int count) {
    int number = 0;
    TrackFrame before{};
    for (const float u : stationsOf(count)) {
        const TrackFrame f = frameAt(u);
        const bool hasPosts = number % 3 == 0;
        const float half = hasPosts ? 0.5F : 0.33F;
        const vec3 low = f.at - 0.06F * f.up;
        addBar(mesh, low - half * f.side, low + half * f.side, 0.022F);
        for (const float side : {-1.0F, 1.0F}) {
            if (!hasPosts) break;
            const vec3 post = low + side * 0.48F * f.side;
            addBar(mesh, post, post + vec3(0, 0.34F, 0), 0.011F);
            const vec3 last = before.at - 0.06F * before.up + side * 0.48F * before.side;
            if (number == 0) continue;
            addBar(mesh, last + vec3(0, 0.33F, 0), post + vec3(0, 0.33F, 0), 0.009F);
            addBar(mesh, last + vec3(0, 0.18F, 0), post + vec3(0, 0.18F, 0), 0.007F);
        }
        if (hasPosts) before = f;
        ++number;
    }
}

// Whether another part of the track runs below, too close for posts.
bool isAboveTrack(const TrackFrame& f, const std::vector<float>& stations) {
    return std::any_of(stations.begin(), stations.end(), [&](float u) {
        const vec3 other = trackAt(u);
        const float aside = glm::length(glm::vec2(other.x - f.at.x, other.z - f.at.z));
        return other.y < f.at.y - 1.2F && aside < 0.95F;
    });
}

// Feet of a bent stand wider than its head.
vec3 postAt(const TrackFrame& f, float side, float y) {
    const vec3 out = glm::normalize(vec3(f.side.x, 0, f.side.z));
    const float spread = 0.3F + 0.075F * (f.at.y - y);
    return vec3(f.at.x, y, f.at.z) + side * spread * out;
}

// A trestle: bents of two posts, braced within and to the next bent.
void addTrestle(Mesh& mesh, int count) {
    constexpr float kStorey = 0.62F;
    const std::vector<float> stations = stationsOf(count);
    for (size_t i = 0; i < stations.size(); ++i) {
        const TrackFrame here = frameAt(stations[i]);
        const TrackFrame next = frameAt(stations[(i + 1) % stations.size()]);
        if (isAboveTrack(here, stations)) continue;
        const bool isLinked = !isAboveTrack(next, stations);
        const float top = here.at.y - 0.1F, nextTop = next.at.y - 0.1F;
        const int storeys = std::max(1, static_cast<int>(std::lround(top / kStorey)));
        for (int storey = 0; storey < storeys; ++storey) {
            const float a = static_cast<float>(storey) / static_cast<float>(storeys);
            const float b = static_cast<float>(storey + 1) / static_cast<float>(storeys);
            for (const float side : {-1.0F, 1.0F}) {
                const vec3 low = postAt(here, side, a * top), high = postAt(here, side, b * top);
                addBar(mesh, low, high, 0.02F);
                addBar(mesh, low, postAt(here, -side, b * top), 0.011F);
                if (!isLinked) continue;
                addBar(mesh, low, postAt(next, side, b * nextTop), 0.011F);
                addBar(mesh, high, postAt(next, side, b * nextTop), 0.013F);
            }
            addBar(mesh, postAt(here, -1, b * top), postAt(here, 1, b * top), 0.014F);
        }
    }
}

// A car: a tub with a nose and two riders.
void addCar(Mesh& tubs, Mesh& riders, const TrackFrame& f) {
    const glm::quat turn = glm::normalize(glm::quat_cast(glm::mat3(f.side, f.up, -f.along)));
    const vec3 seat = f.at + 0.1F * f.up;
    Mesh tub;
    append(tub, makeBox({0, 0.13F, 0}, {0.21F, 0.1F, 0.4F}));
    append(tub, makeBox({0, 0.33F, 0.37F}, {0.19F, 0.16F, 0.035F}));
    append(tub, makeSweep({{{0, 0.13F, -0.38F}, 0.2F, 0.1F}, {{0, 0.12F, -0.55F}, 0.13F, 0.06F}},
                          {0, 1, 0}, 24));
    append(tubs, tub, turn, seat);
    for (const float side : {-1.0F, 1.0F}) {
        Mesh rider = makeSweep({{{0, 0, 0}, 0.07F, 0.06F},
                                {{0, 0.18F, 0}, 0.085F, 0.06F},
                                {{0, 0.24F, 0}, 0.035F, 0.03F}},
                               {0, 0, 1}, 20);
        append(rider, makeSphere(0.062F, 20, 14), {1, 0, 0, 0}, {0, 0.3F, 0});
        // Arms up
        for (const float arm : {-1.0F, 1.0F})
            append(rider,
                   makeBar({0.07F * arm, 0.18F, 0}, {0.085F * arm, 0.42F, -0.06F}, 0.02F, 10));
        append(riders, rider, turn, seat + turn * vec3(0.1F * side, 0.22F, 0.12F));
    }
}

}  // namespace

void makeCoaster(GltfWriter& writer) {
    Exhibit exhibit(writer);
    Mesh timber, tubs, riders;
    addTrestle(timber, 150);
    addSleepers(timber, 560);
    exhibit.add("timber", withNormals(timber, 60), {0.62F, 0.57F, 0.5F});
    for (int car = 0; car < 6; ++car)
        addCar(tubs, riders, frameAt(0.58F - 0.0135F * static_cast<float>(car)));
    exhibit.add("cars", withNormals(tubs, 40), {0.55F, 0.1F, 0.08F}, 0.4F);
    exhibit.add("riders", withNormals(riders, 60), {0.15F, 0.22F, 0.4F}, 0.8F);
    // As finely divided as the number of triangles wants
    Mesh rails;
    const size_t left = exhibit.trianglesLeft(kTriangleCount);
    const std::vector<float> stations = stationsOf(static_cast<int>(left / (3 * 2 * kRailSides)));
    for (const float side : {-1.0F, 1.0F}) addRail(rails, stations, {side * kGauge, 0}, 0.03F);
    addRail(rails, stations, {0, -0.12F}, 0.055F);
    exhibit.add("rails", withNormals(rails, 60), {0.5F, 0.12F, 0.08F}, 0.5F);
    exhibit.finish({.diagonal = 28,
                    .lightDistance = 37,
                    .towardsLight = {-0.4F, 0.85F, -0.35F},
                    .eye = {4, 19, 10.5F},
                    .target = {0.6F, 1, 0.2F},
                    .yfovDeg = 40,
                    .groundColour = {0.5F, 0.55F, 0.42F}});
}

}  // namespace tools
