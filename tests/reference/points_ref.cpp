// SPDX-License-Identifier: MIT
#include "tests/reference/points_ref.h"

#include <algorithm>
#include <cmath>

#include "tests/reference/pose_ref.h"
#include "tests/reference/raster_ref.h"
#include "tests/reference/surface_ref.h"

namespace penumbra::tests {
namespace {

/// The enlarged view in the light's frame: its eye lies `back` metres behind the light's centre.
struct Enlarged {
    Enlarged(const scene::AreaLight& light, const visibility::LightView& view)
        : frame(glm::transpose(glm::dmat3(light.axisX, light.axisY, light.axisZ))),
          centre(light.centre),
          tangent(view.params.tanHalfFov),
          near(view.params.near),
          nearClip(view.params.nearClip),
          back(std::max(light.width, light.height) / (2 * tangent)),  // [VWSS] eq. 1
          half(0.5 * view.params.enlarged),
          size(view.params.enlarged),
          resolution(view.params.resolution) {}

    glm::dvec3 inLight(const glm::dvec3& world) const { return frame * (world - centre); }
    glm::dvec2 pixel(const glm::dvec3& p) const {
        return half + half * glm::dvec2(p) / (tangent * (p.z + back));
    }
    /// Direction of the ray through a pixel's centre; 1 along the light's axis.
    glm::dvec3 ray(int column, int row) const {
        return {tangent * ((column + 0.5) / half - 1), tangent * ((row + 0.5) / half - 1), 1};
    }

    glm::dmat3 frame;
    glm::dvec3 centre;
    double tangent, near, nearClip, back, half;
    int size, resolution;
};

/// A caster in the light's frame.
struct Caster {
    glm::dvec3 v[3];
    glm::dvec3 normal;
    PixelTriangle pixels;
    bool whole = true;  ///< no part is nearer than the near clip
};

Caster casterOf(const Enlarged& view, const PosedTriangle& triangle) {
    Caster c;
    for (std::size_t i = 0; i < 3; ++i) {
        c.v[i] = view.inLight(triangle.corners[i]);
        c.pixels[i] = view.pixel(c.v[i]);
        c.whole &= c.v[i].z >= view.nearClip;
    }
    c.normal = glm::cross(c.v[1] - c.v[0], c.v[2] - c.v[0]);
    return c;
}

/// Front faces wind counter-clockwise as seen from the eye; mirroring transforms turn them round.
bool isFront(const Enlarged& view, const Caster& c, bool mirrored) {
    const glm::dvec3 eye(0, 0, -view.back);
    return (glm::dot(c.normal, eye - c.v[0]) > 0) != mirrored;
}

bool isCulled(visibility::Cull cull, bool front, bool closed) {
    switch (cull) {
        case visibility::Cull::automatic:
            return closed && !front;
        case visibility::Cull::back:
            return !front;
        case visibility::Cull::front:
            return front;
        default:
            return false;
    }
}

glm::dvec3 barycentrics(const Caster& c, const glm::dvec3& p) {
    const double whole = glm::dot(c.normal, c.normal);
    glm::dvec3 b;
    for (int i = 0; i < 3; ++i)
        b[i] = glm::dot(c.normal, glm::cross(c.v[(i + 1) % 3] - p, c.v[(i + 2) % 3] - p)) / whole;
    return b;
}

/// Longest side over the height on it.
double aspect(const Caster& c) {
    double longest = 0;
    for (int i = 0; i < 3; ++i)
        longest = std::max(longest, glm::length(c.pixels[static_cast<std::size_t>(i)] -
                                                c.pixels[static_cast<std::size_t>((i + 1) % 3)]));
    const auto a = c.pixels[1] - c.pixels[0], b = c.pixels[2] - c.pixels[0];
    return longest * longest / std::max(std::abs(a.x * b.y - a.y * b.x), 1e-9);
}

/// The point at a pixel's centre; false where the triangle does not cover it.
bool pointAt(const Enlarged& view, const Caster& c, int column, int row, PointReference& out,
             glm::dvec3& barycentric) {
    if (c.whole && !coversReference(c.pixels, column, row)) return false;
    const glm::dvec3 eye(0, 0, -view.back), ray = view.ray(column, row);
    const double rise = glm::dot(c.normal, ray), distance = glm::dot(c.normal, c.v[0] - eye);
    if (rise == 0) return false;
    // Depth never leaves that of the vertices, where snapping puts a centre beside the triangle
    const double low = std::min({c.v[0].z, c.v[1].z, c.v[2].z}) + view.back;
    const double high = std::max({c.v[0].z, c.v[1].z, c.v[2].z}) + view.back;
    const double along = c.whole ? std::clamp(distance / rise, low, high) : distance / rise;
    const glm::dvec3 p = eye + along * ray;
    barycentric = barycentrics(c, p);
    if (!c.whole &&
        (std::min({barycentric.x, barycentric.y, barycentric.z}) < 0 || p.z < view.nearClip))
        return false;
    const double focal = view.resolution / (2 * view.tangent), middle = 0.5 * view.resolution;
    out.a = focal * p.x / p.z + middle;
    out.b = focal * p.y / p.z + middle;
    out.w = view.near / p.z;
    out.column = column;
    out.row = row;
    // 1/along is affine over the screen; snapped vertices move what a pixel sees by 1/512 pixel
    const double perPixel = (std::abs(c.normal.x) + std::abs(c.normal.y)) * view.tangent /
                            (view.half * std::abs(distance));
    const double inverse = perPixel / 512 + 1e-6 * (1 + aspect(c)) / along;
    out.slackW = view.near / (p.z * p.z) * along * along * inverse;
    // a - C is x (1 + back w / near) on the screen
    const double perW = view.back / view.near * view.resolution / view.size;
    out.slackA = std::abs(column + 0.5 - view.half) * perW * out.slackW + 2e-4;
    out.slackB = std::abs(row + 0.5 - view.half) * perW * out.slackW + 2e-4;
    return true;
}

double opacityOf(const scene::Scene& scene, const scene::Primitive& primitive,
                 const SurfacePoint& point) {
    const auto& material = scene.materials[static_cast<std::size_t>(primitive.material)];
    const double alpha = baseColourReference(scene, primitive, point).w;
    if (material.alphaMode == scene::AlphaMode::mask)
        return alpha >= static_cast<double>(material.alphaCutoff) ? 1 : 0;
    const double blocked = 1 - static_cast<double>(material.transmission);
    return material.alphaMode == scene::AlphaMode::opaque ? blocked : alpha * blocked;
}

const scene::Primitive& primitiveOf(const scene::Scene& scene, const PosedTriangle& triangle) {
    const auto mesh = scene.nodes[static_cast<std::size_t>(triangle.node)].mesh;
    return scene.meshes[static_cast<std::size_t>(mesh)]
        .primitives[static_cast<std::size_t>(triangle.primitive)];
}

void addPoints(const scene::Scene& scene, const Enlarged& view, const PosedTriangle& triangle,
               const Caster& c, int draw, std::vector<PointReference>& points) {
    glm::ivec2 low(0), high(view.size - 1);
    if (c.whole)
        for (int axis = 0; axis < 2; ++axis) {
            const auto [first, last] =
                std::minmax({c.pixels[0][axis], c.pixels[1][axis], c.pixels[2][axis]});
            low[axis] = std::max(0, static_cast<int>(std::floor(std::max(first, -1.0))) - 1);
            high[axis] = std::min(view.size - 1, static_cast<int>(std::min(last, 1e6)) + 1);
        }
    for (int row = low.y; row <= high.y; ++row)
        for (int column = low.x; column <= high.x; ++column) {
            PointReference point;
            SurfacePoint surface;
            if (!pointAt(view, c, column, row, point, surface.barycentric)) continue;
            surface.barycentric = glm::max(surface.barycentric, glm::dvec3(0));
            surface.barycentric /=
                surface.barycentric.x + surface.barycentric.y + surface.barycentric.z;
            surface.vertices = {triangle.indices[0], triangle.indices[1], triangle.indices[2]};
            point.opacity = opacityOf(scene, primitiveOf(scene, triangle), surface);
            point.draw = draw;
            if (point.opacity > 0) points.push_back(point);
        }
}

}  // namespace

std::vector<PointReference> pointsReference(const scene::Scene& scene, const scene::Pose& pose,
                                            const scene::AreaLight& light,
                                            const visibility::LightView& view,
                                            visibility::Cull cull,
                                            const std::function<bool(int node)>& closed) {
    const Enlarged enlarged(light, view);
    std::vector<PointReference> points;
    int draw = -1;
    const PosedTriangle* last = nullptr;
    const auto triangles = posedTriangles(scene, pose);
    for (const auto& triangle : triangles) {
        if (!last || last->node != triangle.node || last->primitive != triangle.primitive) ++draw;
        last = &triangle;
        const auto node = static_cast<std::size_t>(triangle.node);
        if (!scene.nodes[node].castShadow) continue;
        const Caster caster = casterOf(enlarged, triangle);
        const bool mirrored = glm::determinant(glm::dmat3(pose.worldFromNode[node])) < 0;
        if (isCulled(cull, isFront(enlarged, caster, mirrored), closed(triangle.node))) continue;
        addPoints(scene, enlarged, triangle, caster, draw, points);
    }
    return points;
}

}  // namespace penumbra::tests
