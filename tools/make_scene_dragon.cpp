// SPDX-License-Identifier: MIT
// [4DR] Dragon: a winged dragon with a coiled neck and tail as one closed implicit surface,
// modelled at an eighth of its size.
#include <algorithm>
#include <cmath>

#include "make_scene_exhibit.h"
#include "make_scene_field.h"
#include "make_scene_random.h"
#include "make_scene_scenes.h"
#include "make_scene_simplify.h"
#include "make_scene_surface.h"

namespace tools {

using glm::vec3;

namespace {

constexpr size_t kTriangleCount = 81000;
constexpr float kScale = 8;

struct Knot {
    vec3 place;
    float radius;
};

// From the tip of the tail to the nape.
constexpr Knot kSpine[] = {{{-0.6F, 0.06F, 1.5F}, 0.018F},  {{-1.2F, 0.07F, 1.35F}, 0.04F},
                           {{-1.65F, 0.09F, 0.85F}, 0.07F}, {{-1.6F, 0.14F, 0.2F}, 0.11F},
                           {{-1.2F, 0.3F, -0.2F}, 0.17F},   {{-0.65F, 0.55F, -0.25F}, 0.26F},
                           {{0.0F, 0.66F, -0.1F}, 0.32F},   {{0.5F, 0.78F, 0.0F}, 0.27F},
                           {{0.85F, 1.05F, 0.02F}, 0.18F},  {{0.92F, 1.4F, 0.12F}, 0.14F},
                           {{0.85F, 1.68F, 0.3F}, 0.125F},  {{1.0F, 1.86F, 0.5F}, 0.115F}};
constexpr int kSegments = 10;  // of a stretch between knots

struct Link {
    Knot a, b;
    vec3 middle;
    float reach;  // radius of a ball around it
};

Link makeLink(const Knot& a, const Knot& b) {
    return {a, b, 0.5F * (a.place + b.place),
            0.5F * glm::distance(a.place, b.place) + std::max(a.radius, b.radius)};
}

Knot splineAt(float t) {
    constexpr int kLast = static_cast<int>(std::size(kSpine)) - 1;
    const int i = std::clamp(static_cast<int>(t), 0, kLast - 1);
    const auto at = [&](int k) { return kSpine[std::clamp(k, 0, kLast)]; };
    const float s = t - static_cast<float>(i);
    // Catmull and Rom 1974
    const auto blend = [s](const auto& a, const auto& b, const auto& c, const auto& d) {
        return 0.5F * (2.0F * b + (c - a) * s + (2.0F * a - 5.0F * b + 4.0F * c - d) * (s * s) +
                       (3.0F * b - a - 3.0F * c + d) * (s * s * s));
    };
    return {blend(at(i - 1).place, at(i).place, at(i + 1).place, at(i + 2).place),
            blend(at(i - 1).radius, at(i).radius, at(i + 1).radius, at(i + 2).radius)};
}

void addChain(std::vector<Link>& links, const std::vector<Knot>& knots) {
    for (size_t i = 0; i + 1 < knots.size(); ++i) links.push_back(makeLink(knots[i], knots[i + 1]));
}

std::vector<Link> makeSpine() {
    std::vector<Knot> knots;
    constexpr int kCount = kSegments * (static_cast<int>(std::size(kSpine)) - 1);
    for (int i = 0; i <= kCount; ++i) knots.push_back(splineAt(static_cast<float>(i) / kSegments));
    std::vector<Link> links;
    addChain(links, knots);
    return links;
}

// Four legs with three claws each.
std::vector<Link> makeLegs() {
    std::vector<Link> links;
    const struct {
        float x, z, hip, lean;
    } legs[] = {{0.55F, 0.27F, 0.66F, 0.14F},
                {0.6F, -0.3F, 0.66F, 0.02F},
                {-0.5F, 0.22F, 0.5F, -0.05F},
                {-0.55F, -0.6F, 0.5F, -0.12F}};
    for (const auto& leg : legs) {
        const float out = leg.z > 0 ? 1.0F : -1.0F;
        const vec3 foot(leg.x + 0.1F + leg.lean, 0.07F, leg.z + 0.32F * out);
        addChain(links, {{{leg.x - 0.05F, leg.hip, leg.z}, 0.17F},
                         {{leg.x - 0.16F + leg.lean, 0.36F, leg.z + 0.27F * out}, 0.11F},
                         {{foot.x - 0.06F, 0.14F, foot.z}, 0.075F},
                         {foot, 0.075F}});
        for (const float claw : {-1.0F, 0.0F, 1.0F}) {
            const vec3 toe = foot + vec3(0.15F, -0.015F, 0.085F * claw);
            addChain(links,
                     {{foot, 0.05F}, {toe, 0.038F}, {toe + vec3(0.08F, -0.025F, 0), 0.016F}});
        }
    }
    return links;
}

// Skull, jaws apart, brows, horns, frill and teeth; the snout points along `ahead`.
std::vector<Link> makeHead() {
    std::vector<Link> links;
    const vec3 nape = kSpine[std::size(kSpine) - 1].place;
    const vec3 ahead = glm::normalize(vec3(0.75F, -0.22F, 0.55F));
    const vec3 side = glm::normalize(glm::cross(ahead, vec3(0, 1, 0)));
    const vec3 up = glm::cross(side, ahead);
    const auto at = [&](float x, float y, float z) { return nape + x * ahead + y * up + z * side; };
    addChain(links, {{at(0, 0, 0), 0.12F},
                     {at(0.14F, 0.05F, 0), 0.135F},
                     {at(0.38F, 0.03F, 0), 0.08F},
                     {at(0.52F, 0.03F, 0), 0.066F}});
    addChain(links, {{at(0.08F, -0.04F, 0), 0.1F},
                     {at(0.3F, -0.14F, 0), 0.052F},
                     {at(0.47F, -0.17F, 0), 0.036F}});
    for (const float s : {-1.0F, 1.0F}) {
        addChain(links, {{at(0.02F, 0.1F, 0.07F * s), 0.045F},
                         {at(-0.16F, 0.22F, 0.13F * s), 0.034F},
                         {at(-0.33F, 0.27F, 0.2F * s), 0.022F},
                         {at(-0.46F, 0.4F, 0.22F * s), 0.009F}});
        addChain(links,
                 {{at(0.1F, 0.14F, 0.08F * s), 0.035F}, {at(0.25F, 0.1F, 0.07F * s), 0.03F}});
        addChain(links,
                 {{at(0.5F, 0.07F, 0.04F * s), 0.03F}, {at(0.5F, 0.1F, 0.045F * s), 0.016F}});
        for (int spike = 0; spike < 3; ++spike) {
            const float turn = 0.25F - 0.55F * static_cast<float>(spike);
            addChain(links, {{at(0, 0.03F * turn, 0.1F * s), 0.03F},
                             {at(-0.2F, 0.3F * turn, 0.26F * s), 0.009F}});
        }
        for (int tooth = 0; tooth < 5; ++tooth) {
            const float x = 0.27F + 0.055F * static_cast<float>(tooth);
            const float z = s * (0.062F - 0.004F * static_cast<float>(tooth));
            addChain(links, {{at(x, -0.02F, z), 0.014F}, {at(x + 0.01F, -0.085F, z), 0.007F}});
        }
    }
    return links;
}

// Plates along the back and the tail, the highest above the shoulders.
std::vector<Link> makeRidge() {
    std::vector<Link> links;
    for (int i = 3; i < 52; ++i) {
        const float t = 0.21F * static_cast<float>(i);
        const Knot here = splineAt(t), next = splineAt(t + 0.2F);
        const vec3 along = glm::normalize(next.place - here.place);
        const vec3 lift = glm::normalize(vec3(0, 1, 0) - along * along.y - 0.35F * along);
        // Down the neck they stand to the back
        const vec3 out = along.y > 0.75F ? glm::normalize(vec3(-along.y, 0.3F, -0.4F)) : lift;
        const float height = 0.05F + 0.42F * here.radius;
        addChain(links, {{here.place + 0.9F * here.radius * out, 0.16F * here.radius + 0.012F},
                         {here.place + (here.radius + height) * out, 0.008F}});
    }
    return links;
}

// A wing: arm, fingers, and a skin between them that sags.
struct Wing {
    vec3 shoulder, elbow, wrist;
    std::vector<vec3> tips;
};

std::vector<Wing> makeWings() {
    return {{{0.35F, 0.98F, 0.2F},
             {0.05F, 1.35F, 0.62F},
             {0.42F, 1.7F, 0.95F},
             {{0.2F, 1.55F, 1.85F},
              {-0.4F, 1.32F, 1.75F},
              {-0.85F, 1.05F, 1.35F},
              {-0.62F, 0.8F, 0.45F}}},
            {{0.3F, 0.98F, -0.22F},
             {-0.02F, 1.42F, -0.58F},
             {0.25F, 1.82F, -0.85F},
             {{-0.15F, 1.9F, -1.7F},
              {-0.7F, 1.6F, -1.65F},
              {-1.1F, 1.25F, -1.3F},
              {-0.75F, 0.85F, -0.4F}}}};
}

// Distance to a triangle (Quilez).
float triangleDistance(const vec3& p, const vec3& a, const vec3& b, const vec3& c) {
    const vec3 ba = b - a, cb = c - b, ac = a - c, normal = glm::cross(ba, ac);
    const auto isIn = [&](const vec3& edge, const vec3& from) {
        return glm::dot(glm::cross(edge, normal), p - from) >= 0;
    };
    if (isIn(ba, a) && isIn(cb, b) && isIn(ac, c))
        return std::abs(glm::dot(normal, p - a)) / glm::length(normal);
    const auto toEdge = [&](const vec3& edge, const vec3& from) {
        const float t = std::clamp(glm::dot(edge, p - from) / glm::dot(edge, edge), 0.0F, 1.0F);
        return glm::length(p - from - t * edge);
    };
    return std::min({toEdge(ba, a), toEdge(cb, b), toEdge(ac, c)});
}

struct Dragon {
    std::vector<Link> spine = makeSpine(), limbs, details;
    std::vector<Wing> wings = makeWings();

    Dragon() {
        limbs = makeLegs();
        details = makeHead();
        const std::vector<Link> ridge = makeRidge();
        details.insert(details.end(), ridge.begin(), ridge.end());
        for (const Wing& wing : wings) {
            addChain(limbs, {{wing.shoulder, 0.11F}, {wing.elbow, 0.06F}, {wing.wrist, 0.045F}});
            addChain(details, {{wing.wrist, 0.035F}, {wing.wrist + vec3(0.1F, 0.14F, 0), 0.008F}});
            for (const vec3& tip : wing.tips) {
                const vec3 knuckle = 0.5F * (wing.wrist + tip) + vec3(0, 0.09F, 0);
                addChain(details, {{wing.wrist, 0.036F}, {knuckle, 0.028F}, {tip, 0.014F}});
            }
        }
    }

    // Blend of links, those out of reach left out.
    static float blend(float d, const std::vector<Link>& links, const vec3& p, float k) {
        for (const Link& link : links) {
            if (glm::distance(p, link.middle) - link.reach > d + k) continue;
            d = smoothMin(d, capsule(p, link.a.place, link.b.place, link.a.radius, link.b.radius),
                          k);
        }
        return d;
    }

    float skinDistance(const vec3& p) const {
        constexpr float kHalfThickness = 0.018F;
        float d = 1e3F;
        for (const Wing& wing : wings) {
            vec3 before = wing.tips.front();
            for (size_t i = 1; i < wing.tips.size(); ++i) {
                const vec3& tip = wing.tips[i];
                const vec3 lift(0, 0.07F, 0);
                // Between two fingers the edge is drawn in towards the wrist
                const vec3 edge = glm::mix(0.5F * (before + tip), wing.wrist, 0.2F);
                const vec3 u = 0.5F * (wing.wrist + before) + lift,
                           v = 0.5F * (wing.wrist + tip) + lift;
                const vec3 root = i + 1 == wing.tips.size() ? wing.elbow : wing.wrist;
                d = std::min({d, triangleDistance(p, root, u, edge),
                              triangleDistance(p, u, before, edge),
                              triangleDistance(p, root, edge, v), triangleDistance(p, edge, tip, v),
                              triangleDistance(p, root, wing.wrist, u)});
                before = tip;
            }
            d = std::min(d, triangleDistance(p, wing.shoulder, wing.elbow, wing.tips.back()));
        }
        return d - kHalfThickness;
    }

    float distance(const vec3& p) const {
        const float trunk = blend(1e3F, spine, p, 0.02F);
        float d = blend(trunk, limbs, p, 0.09F);
        // Scales: rows of bumps where the body is thick
        if (std::abs(d) < 0.05F)
            d -= 0.006F * std::abs(std::sin(31 * p.x) * std::sin(37 * p.y) * std::sin(31 * p.z)) +
                 0.006F * noiseAt(9.0F * p);
        d = blend(d, details, p, 0.022F);
        return smoothMin(d, skinDistance(p), 0.03F);
    }
};

std::vector<float> makeSteps(float low, float high, float step) {
    std::vector<float> planes;
    for (float at = low; at < high; at += step) planes.push_back(at);
    return planes;
}

Mesh makeBody(size_t triangleCount) {
    constexpr float kStep = 0.0185F;
    const Dragon dragon;
    Mesh mesh = polygonise([&](const vec3& p) { return dragon.distance(p); },
                           {makeSteps(-1.95F, 1.75F, kStep), makeSteps(-0.15F, 2.5F, kStep),
                            makeSteps(-1.95F, 2.05F, kStep)});
    std::printf("%-12s %6zu triangles before\n", "dragon", mesh.triangleCount());
    std::vector<uint8_t> none;
    simplify(mesh, none, triangleCount);
    for (vec3& position : mesh.positions) position *= kScale;
    return withNormals(mesh, 45);
}

}  // namespace

void makeDragon(GltfWriter& writer) {
    Exhibit exhibit(writer);
    exhibit.add("dragon", makeBody(exhibit.trianglesLeft(kTriangleCount)), {0.24F, 0.38F, 0.22F},
                0.55F);
    exhibit.finish({.diagonal = 58,
                    .lightDistance = 32,
                    .towardsLight = {-0.56F, 0.79F, -0.24F},
                    .eye = {9, 38, 23},
                    .target = {2, 1.5F, 1},
                    .yfovDeg = 41,
                    .groundColour = {0.6F, 0.55F, 0.46F}});
}

}  // namespace tools
