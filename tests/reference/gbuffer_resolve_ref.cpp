// SPDX-License-Identifier: MIT
#include "tests/reference/gbuffer_resolve_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

template <typename Vector>
auto weighted(const FlatTriangle& t, const std::vector<Vector>& values, const glm::dvec3& weights) {
    glm::vec<Vector::length(), double> sum(0);
    for (int i = 0; i < 3; ++i)
        sum += weights[i] *
               glm::vec<Vector::length(), double>(values[t.vertex[static_cast<std::size_t>(i)]]);
    return sum;
}

glm::dvec2 uvAt(const FlatTriangle& t, const scene::TextureRef& use, const glm::dvec3& weights) {
    return weighted(t, t.primitive->uvs[static_cast<std::size_t>(use.uvSet)], weights);
}

glm::dvec3 normalised(const glm::dvec3& v) {
    return v / glm::length(v);
}

}  // namespace

ResolveReference::ResolveReference(const scene::Scene& scene, const scene::Scene& last,
                                   const scene::CameraFrame& camera, int width, int height)
    : scene_(&scene),
      camera_(camera),
      width_(width),
      height_(height),
      triangles_(flatTriangles(scene)),
      last_(flatTriangles(last)) {}

int ResolveReference::triangleAt(std::uint32_t object, int column, int row, double& margin) const {
    const auto line = sightLine(camera_, width_, height_, column + 0.5, row + 0.5);
    int found = -1;
    margin = -1e300;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        if (triangles_[i].object != object) continue;
        const PlaneHit hit = hitPlane(triangles_[i], line);
        const double least = std::min({hit.weights.x, hit.weights.y, hit.weights.z});
        if (hit.depth <= 0 || !(least > margin)) continue;
        margin = least;
        found = static_cast<int>(i);
    }
    return found;
}

const TextureReference& ResolveReference::texture(const scene::TextureRef& use, bool srgb) const {
    auto& entry = textures_[&use];
    if (!entry)
        entry = std::make_unique<TextureReference>(
            scene_->images[static_cast<std::size_t>(use.image)], use, srgb);
    return *entry;
}

glm::dvec4 ResolveReference::read(const FlatTriangle& t, const scene::TextureRef& use, bool srgb,
                                  const Footprint& footprint, bool& atBorder) const {
    if (use.image < 0) return glm::dvec4(1);
    const auto& image = texture(use, srgb);
    const glm::dvec2 uv = uvAt(t, use, footprint.at.weights);
    const double size = image.level(uv, uvAt(t, use, footprint.right.weights),
                                    uvAt(t, use, footprint.below.weights));
    const int level = std::max(static_cast<int>(std::floor(size + footprint.levelBias)), 0);
    atBorder |= image.atTexelBorder(uv, level);
    return image.read(uv, level);
}

/// The normal that a texel of the normal map stands for: x along growing u, y up in the image
/// (against v), z along the vertices' normal. Mirroring a node mirrors its bumps.
glm::dvec3 ResolveReference::bumped(const FlatTriangle& t, const glm::dvec3& normal,
                                    const glm::dvec3& weights, const glm::dvec4& texel) const {
    const auto& use = t.material->normalTexture;
    glm::dvec3 tangent, up;
    if (!t.primitive->tangents.empty()) {
        const glm::dmat3 linear(t.worldFromNode);
        tangent = glm::dvec3(0);
        for (int i = 0; i < 3; ++i)
            tangent +=
                weights[i] *
                normalised(
                    linear *
                    glm::dvec3(t.primitive->tangents[t.vertex[static_cast<std::size_t>(i)]]));
        const double sign = glm::determinant(linear) < 0 ? -1 : 1;
        up = sign * static_cast<double>(t.primitive->tangents[t.vertex[0]].w) *
             glm::cross(normal, tangent);
    } else {
        // Solve P = P0 + u dP/du + v dP/dv for the two gradients
        const auto& image = texture(use, false);
        const auto& uvs = t.primitive->uvs[static_cast<std::size_t>(use.uvSet)];
        const glm::dvec2 origin = image.transform(glm::dvec2(uvs[t.vertex[0]]));
        const glm::dmat2 steps(image.transform(glm::dvec2(uvs[t.vertex[1]])) - origin,
                               image.transform(glm::dvec2(uvs[t.vertex[2]])) - origin);
        const glm::dmat2x3 edges(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
        const glm::dmat2x3 gradients = edges * glm::inverse(steps);
        tangent = gradients[0];
        up = -gradients[1];
    }
    tangent = normalised(tangent - glm::dot(tangent, normal) * normal);
    glm::dvec3 bitangent = glm::cross(normal, tangent);
    if (glm::dot(bitangent, up) < 0) bitangent = -bitangent;
    const glm::dvec3 bump = 2.0 * glm::dvec3(texel) - 1.0;
    const double scale = t.material->normalScale;
    return normalised(scale * bump.x * tangent + scale * bump.y * bitangent + bump.z * normal);
}

SurfaceReference ResolveReference::surface(int triangle, int column, int row,
                                           double levelBias) const {
    const FlatTriangle& t = triangles_[static_cast<std::size_t>(triangle)];
    const scene::Material& m = *t.material;
    const auto hitAt = [&](double x, double y) {
        return hitPlane(t, sightLine(camera_, width_, height_, x + 0.5, y + 0.5));
    };
    const Footprint footprint{hitAt(column, row), hitAt(column + 1, row), hitAt(column, row + 1),
                              levelBias};
    const glm::dvec3 weights = footprint.at.weights;
    const auto line = sightLine(camera_, width_, height_, column + 0.5, row + 0.5);
    SurfaceReference s;
    s.position = footprint.at.position;
    s.depth = footprint.at.depth;
    const auto& before = last_[static_cast<std::size_t>(triangle)].corner;
    s.previous = weights.x * before[0] + weights.y * before[1] + weights.z * before[2];
    s.geometric = normalised(glm::cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]));
    if (glm::dot(s.geometric, line.direction) > 0) s.geometric = -s.geometric;
    const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(t.worldFromNode)));
    // Normals are made unit after they are moved, per vertex, before interpolation
    glm::dvec3 sum(0);
    for (int i = 0; i < 3; ++i)
        sum += weights[i] *
               normalised(normalMatrix *
                          glm::dvec3(t.primitive->normals[t.vertex[static_cast<std::size_t>(i)]]));
    s.normal = normalised(sum);
    const bool reversed = glm::dot(s.normal, s.geometric) < 0;
    glm::dvec4 colour =
        glm::dvec4(m.baseColor) * read(t, m.baseColorTexture, true, footprint, s.atTexelBorder);
    if (!t.primitive->colors.empty()) colour *= weighted(t, t.primitive->colors, weights);
    if (m.alphaMode == scene::AlphaMode::blend) s.alpha = std::clamp(colour.w, 0.0, 1.0);
    const double transmission =
        m.alphaMode == scene::AlphaMode::mask ? 0 : static_cast<double>(m.transmission);
    s.through = 1 - s.alpha + s.alpha * transmission * glm::dvec3(colour);
    s.albedo = (1 - transmission) * glm::dvec3(colour);
    s.emissive = glm::dvec3(m.emissive) *
                 glm::dvec3(read(t, m.emissiveTexture, true, footprint, s.atTexelBorder));
    const auto rough = read(t, m.metallicRoughnessTexture, false, footprint, s.atTexelBorder);
    s.roughness = m.roughness * rough.y;
    s.metallic = m.metallic * rough.z;
    if (m.normalTexture.image >= 0)
        s.normal = bumped(t, s.normal, weights,
                          read(t, m.normalTexture, false, footprint, s.atTexelBorder));
    // glTF 3.9.5: a back has its normals reversed before lighting, bumps included
    if (reversed) s.normal = -s.normal;
    if (m.unlit) {
        s.emissive = s.albedo;
        s.albedo = glm::dvec3(0);
        s.metallic = 0;
    }
    return s;
}

}  // namespace penumbra::tests
