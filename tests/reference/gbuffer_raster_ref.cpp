// SPDX-License-Identifier: MIT
#include "tests/reference/gbuffer_raster_ref.h"

#include <algorithm>
#include <cmath>

#include "tests/reference/raster_ref.h"

namespace penumbra::tests {
namespace {

/// Metres along the camera's axis.
double metresTo(const scene::CameraFrame& camera, const glm::dvec3& point) {
    return -glm::dot(point - glm::dvec3(camera.worldFromCamera[3]),
                     glm::dvec3(camera.worldFromCamera[2]));
}

/// The part of a triangle that lies beyond the near plane.
std::vector<glm::dvec3> clipToNear(const scene::CameraFrame& camera, const FlatTriangle& t) {
    std::vector<glm::dvec3> kept;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 p = t.corner[i], q = t.corner[(i + 1) % 3];
        const double dp = metresTo(camera, p) - camera.nearMetres;
        const double dq = metresTo(camera, q) - camera.nearMetres;
        if (dp >= 0) kept.push_back(p);
        if ((dp >= 0) != (dq >= 0)) kept.push_back(p + (q - p) * (dp / (dp - dq)));
    }
    return kept;
}

glm::dvec2 pixelOf(const scene::CameraFrame& camera, int width, int height,
                   const glm::dvec3& point) {
    const glm::dvec3 offset = point - glm::dvec3(camera.worldFromCamera[3]);
    double right = glm::dot(offset, glm::dvec3(camera.worldFromCamera[0]));
    double up = glm::dot(offset, glm::dvec3(camera.worldFromCamera[1]));
    if (camera.orthographic) {
        right /= camera.xmag;
        up /= camera.ymag;
    } else {
        const double half = metresTo(camera, point) * std::tan(camera.yfovRad / 2);
        right /= half * width / height;
        up /= half;
    }
    return {0.5 * width * (1 + right), 0.5 * height * (1 - up)};
}

/// Vertices move by up to 1/512 pixel along each axis; in units of the triangle's least height.
double snappingSlack(const std::vector<glm::dvec2>& corners) {
    double worst = 0;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        const glm::dvec2 a = corners[i] - corners[0], b = corners[i + 1] - corners[0];
        const double longest = std::max({glm::length(a), glm::length(b), glm::length(a - b)});
        const double area = std::abs(a.x * b.y - a.y * b.x);
        worst = std::max(worst, longest / std::max(area, 1e-12));
    }
    return std::min(1.0, worst * 4 * std::sqrt(2.0) / 512);
}

}  // namespace

RasterReference::RasterReference(const scene::Scene& scene, const scene::CameraFrame& camera,
                                 int width, int height)
    : camera_(camera), width_(width), height_(height), triangles_(flatTriangles(scene)) {
    for (const auto& triangle : triangles_) {
        screens_.push_back(project(triangle));
        const auto& use = triangle.material->baseColorTexture;
        colourTextures_.push_back(
            use.image < 0 ? nullptr
                          : std::make_unique<TextureReference>(
                                scene.images[static_cast<std::size_t>(use.image)], use, true));
    }
}

double RasterReference::depthOf(double metres) const {
    if (!camera_.orthographic) return camera_.nearMetres / metres;
    return 1 - (metres - camera_.nearMetres) / (2 * (camera_.farMetres - camera_.nearMetres));
}

RasterReference::Screen RasterReference::project(const FlatTriangle& t) const {
    Screen screen;
    screen.depthLow = 1;
    for (const auto& corner : clipToNear(camera_, t)) {
        screen.pixel.push_back(pixelOf(camera_, width_, height_, corner));
        const double depth = depthOf(metresTo(camera_, corner));
        screen.depthLow = std::min(screen.depthLow, depth);
        screen.depthHigh = std::max(screen.depthHigh, depth);
    }
    screen.relativeSlack = snappingSlack(screen.pixel);
    // glTF 3.7.4: fronts turn counter-clockwise, clockwise where the node mirrors
    const glm::dvec3 normal = glm::cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
    const glm::dvec3 towards = camera_.orthographic
                                   ? glm::dvec3(camera_.worldFromCamera[2])
                                   : glm::dvec3(camera_.worldFromCamera[3]) - t.corner[0];
    const double sign = glm::determinant(glm::dmat3(t.worldFromNode)) < 0 ? -1 : 1;
    screen.faces = t.material->doubleSided || sign * glm::dot(normal, towards) > 0;
    return screen;
}

double RasterReference::alphaOf(const FlatTriangle& t, const PlaneHit& hit) const {
    double alpha = t.material->baseColor.w;
    const auto index = static_cast<std::size_t>(&t - triangles_.data());
    // Snapping may cover a centre that lies a little outside: the nearest point of the triangle
    glm::dvec3 weights = glm::max(hit.weights, 0.0);
    weights /= weights.x + weights.y + weights.z;
    if (colourTextures_[index]) {
        const auto& uvs =
            t.primitive->uvs[static_cast<std::size_t>(t.material->baseColorTexture.uvSet)];
        glm::dvec2 uv(0);
        for (int i = 0; i < 3; ++i)
            uv += weights[i] * glm::dvec2(uvs[t.vertex[static_cast<std::size_t>(i)]]);
        alpha *= colourTextures_[index]->read(uv, 0).w;
    }
    if (!t.primitive->colors.empty()) {
        double colour = 0;
        for (int i = 0; i < 3; ++i)
            colour += weights[i] * t.primitive->colors[t.vertex[static_cast<std::size_t>(i)]].w;
        alpha *= colour;
    }
    return alpha;
}

std::vector<RasterFragment> RasterReference::covering(int column, int row) const {
    std::vector<RasterFragment> found;
    const auto line = sightLine(camera_, width_, height_, column + 0.5, row + 0.5);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Screen& screen = screens_[i];
        if (!screen.faces) continue;
        bool covered = false;
        for (std::size_t c = 1; c + 1 < screen.pixel.size(); ++c)
            covered |= coversReference({screen.pixel[0], screen.pixel[c], screen.pixel[c + 1]},
                                       column, row);
        if (!covered) continue;
        const PlaneHit hit = hitPlane(triangles_[i], line);
        RasterFragment fragment;
        fragment.triangle = static_cast<int>(i);
        fragment.depth = hit.depth > 0 ? depthOf(hit.depth) : 1;
        fragment.depth = std::clamp(fragment.depth, screen.depthLow, screen.depthHigh);
        fragment.slack = screen.relativeSlack * (screen.depthHigh - screen.depthLow) + 2e-6;
        found.push_back(fragment);
    }
    return found;
}

std::vector<RasterFragment> RasterReference::fragments(int column, int row) const {
    std::vector<RasterFragment> found;
    const auto line = sightLine(camera_, width_, height_, column + 0.5, row + 0.5);
    for (auto fragment : covering(column, row)) {
        const auto& triangle = triangles_[static_cast<std::size_t>(fragment.triangle)];
        const auto& material = *triangle.material;
        const bool mask = material.alphaMode == scene::AlphaMode::mask;
        if (material.transmission > 0 && !mask) continue;
        if (material.alphaMode != scene::AlphaMode::opaque) {
            const bool varies =
                material.baseColorTexture.image >= 0 || !triangle.primitive->colors.empty();
            const double alpha = alphaOf(triangle, hitPlane(triangle, line));
            const double threshold = mask ? material.alphaCutoff : 0.9999;
            fragment.doubtful = varies && std::abs(alpha - threshold) < 2e-3;
            if (alpha < threshold && !fragment.doubtful) continue;
        }
        found.push_back(fragment);
    }
    return found;
}

}  // namespace penumbra::tests
