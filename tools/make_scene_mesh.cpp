// SPDX-License-Identifier: MIT
// Builds every shape from stacks of rings, then computes normals with creases.
#include "make_scene_mesh.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace tools {

namespace {

// Joins rings of equal size, counter-clockwise about the direction of travel, and closes both ends
// by fans.
Mesh joinRings(const std::vector<std::vector<glm::vec3>>& rings) {
    Mesh mesh;
    const auto sides = static_cast<uint32_t>(rings.front().size());
    for (const auto& ring : rings) {
        mesh.positions.insert(mesh.positions.end(), ring.begin(), ring.end());
    }
    const auto addTriangle = [&](uint32_t a, uint32_t b, uint32_t c) {
        mesh.indices.insert(mesh.indices.end(), {a, b, c});
    };
    for (uint32_t ring = 0; ring + 1 < rings.size(); ++ring) {
        for (uint32_t side = 0; side < sides; ++side) {
            const uint32_t here = ring * sides + side;
            const uint32_t beside = ring * sides + (side + 1) % sides;
            addTriangle(here, beside, beside + sides);
            addTriangle(here, beside + sides, here + sides);
        }
    }
    const auto addCap = [&](uint32_t first, bool isStart) {
        glm::vec3 centre(0);
        for (uint32_t side = 0; side < sides; ++side) centre += mesh.positions[first + side];
        mesh.positions.push_back(centre / static_cast<float>(sides));
        const auto apex = static_cast<uint32_t>(mesh.positions.size() - 1);
        for (uint32_t side = 0; side < sides; ++side) {
            const uint32_t here = first + side;
            const uint32_t beside = first + (side + 1) % sides;
            addTriangle(apex, isStart ? beside : here, isStart ? here : beside);
        }
    };
    addCap(0, true);
    addCap(static_cast<uint32_t>(rings.size() - 1) * sides, false);
    return mesh;
}

float angleOf(uint32_t index, uint32_t count) {
    return glm::two_pi<float>() * static_cast<float>(index) / static_cast<float>(count);
}

}  // namespace

Mesh makeSweep(const std::vector<SweepRing>& rings, const glm::vec3& up, uint32_t sides) {
    std::vector<std::vector<glm::vec3>> points;
    for (size_t i = 0; i < rings.size(); ++i) {
        const glm::vec3 before = rings[i > 0 ? i - 1 : 0].centre;
        const glm::vec3 after = rings[i + 1 < rings.size() ? i + 1 : i].centre;
        const glm::vec3 forward = glm::normalize(after - before);
        const glm::vec3 high = glm::normalize(up - forward * glm::dot(up, forward));
        const glm::vec3 wide = glm::cross(high, forward);
        std::vector<glm::vec3> ring;
        for (uint32_t side = 0; side < sides; ++side) {
            const float angle = angleOf(side, sides);
            ring.push_back(rings[i].centre + wide * (rings[i].halfWidth * std::cos(angle)) +
                           high * (rings[i].halfHeight * std::sin(angle)));
        }
        points.push_back(std::move(ring));
    }
    return joinRings(points);
}

Mesh makeBar(const glm::vec3& from, const glm::vec3& to, float radius, uint32_t sides) {
    const glm::vec3 along = glm::normalize(to - from);
    const glm::vec3 up = std::abs(along.y) < 0.9F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    return makeSweep({{from, radius, radius}, {to, radius, radius}}, up, sides);
}

Mesh makeLathe(const std::vector<glm::vec2>& profile, uint32_t sides) {
    std::vector<std::vector<glm::vec3>> points;
    for (const glm::vec2& corner : profile) {
        std::vector<glm::vec3> ring;
        for (uint32_t side = 0; side < sides; ++side) {
            const float angle = angleOf(side, sides);
            ring.emplace_back(corner.x * std::sin(angle), corner.y, corner.x * std::cos(angle));
        }
        points.push_back(std::move(ring));
    }
    return joinRings(points);
}

Mesh makeTorus(float majorRadius, float minorRadius, uint32_t majorSides, uint32_t minorSides) {
    Mesh mesh;
    for (uint32_t i = 0; i < majorSides; ++i) {
        for (uint32_t j = 0; j < minorSides; ++j) {
            const float around = angleOf(i, majorSides);
            const float tube = angleOf(j, minorSides);
            const float radius = majorRadius + minorRadius * std::cos(tube);
            mesh.positions.emplace_back(radius * std::sin(around), minorRadius * std::sin(tube),
                                        radius * std::cos(around));
            const uint32_t nextI = (i + 1) % majorSides;
            const uint32_t nextJ = (j + 1) % minorSides;
            const uint32_t a = i * minorSides + j;
            const uint32_t b = nextI * minorSides + j;
            const uint32_t c = nextI * minorSides + nextJ;
            const uint32_t d = i * minorSides + nextJ;
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        }
    }
    return mesh;
}

Mesh makeSphere(float radius, uint32_t sides, uint32_t rings) {
    std::vector<glm::vec2> profile;
    for (uint32_t ring = 1; ring < rings; ++ring) {
        const float polar = glm::pi<float>() * static_cast<float>(ring) / static_cast<float>(rings);
        profile.emplace_back(radius * std::sin(polar), -radius * std::cos(polar));
    }
    Mesh mesh = makeLathe(profile, sides);
    // The fans' centres are the last two vertices: lift them from the ring planes to the poles.
    mesh.positions[mesh.positions.size() - 2] = glm::vec3(0, -radius, 0);
    mesh.positions.back() = glm::vec3(0, radius, 0);
    return mesh;
}

Mesh makeBox(const glm::vec3& centre, const glm::vec3& halfExtents) {
    Mesh mesh;
    for (uint32_t corner = 0; corner < 8; ++corner) {
        const glm::vec3 sign((corner & 1U) ? 1 : -1, (corner & 2U) ? 1 : -1,
                             (corner & 4U) ? 1 : -1);
        mesh.positions.push_back(centre + sign * halfExtents);
    }
    mesh.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    return mesh;
}

Mesh makeBlock(const glm::vec3& centre, const glm::vec3& half, float cut) {
    Mesh mesh;
    // Three vertices a corner: on its faces across x, y and z
    for (uint32_t corner = 0; corner < 8; ++corner) {
        const glm::vec3 sign((corner & 1U) ? 1 : -1, (corner & 2U) ? 1 : -1,
                             (corner & 4U) ? 1 : -1);
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 in = half - cut;
            in[axis] = half[axis];
            mesh.positions.push_back(centre + sign * in);
        }
        const bool isMirrored = sign.x * sign.y * sign.z < 0;
        const uint32_t a = 3 * corner;
        mesh.indices.insert(mesh.indices.end(),
                            {a, isMirrored ? a + 2 : a + 1, isMirrored ? a + 1 : a + 2});
    }
    const auto addQuad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        // Counter-clockwise from outside, whichever way the corners were named
        const glm::vec3 out = mesh.positions[a] + mesh.positions[c] - 2.0F * centre;
        const glm::vec3 normal = glm::cross(mesh.positions[b] - mesh.positions[a],
                                            mesh.positions[c] - mesh.positions[a]);
        if (glm::dot(out, normal) < 0) std::swap(b, d);
        mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    };
    for (uint32_t axis = 0; axis < 3; ++axis) {
        const uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3, du = 1U << u, dv = 1U << v;
        for (const uint32_t side : {0U, 1U << axis})
            addQuad(3 * side + axis, 3 * (side + du) + axis, 3 * (side + du + dv) + axis,
                    3 * (side + dv) + axis);
        for (const uint32_t edge : {0U, du, dv, du + dv})
            addQuad(3 * edge + u, 3 * (edge + (1U << axis)) + u, 3 * (edge + (1U << axis)) + v,
                    3 * edge + v);
    }
    return mesh;
}

void append(Mesh& mesh, const Mesh& part, const glm::quat& rotation, const glm::vec3& translation) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    for (const glm::vec3& position : part.positions) {
        mesh.positions.push_back(rotation * position + translation);
    }
    for (const uint32_t index : part.indices) mesh.indices.push_back(base + index);
}

void addStrut(Mesh& mesh, const glm::vec3& from, const glm::vec3& to, float radius,
              uint32_t sides) {
    const float number = static_cast<float>(mesh.positions.size() % 8191U);
    const float share = 0.618034F * number - std::floor(0.618034F * number);
    const glm::vec3 reach = radius * (0.1F + 0.5F * share) * glm::normalize(to - from);
    append(mesh, makeBar(from - reach, to + reach, radius, sides));
}

Mesh withNormals(const Mesh& mesh, float creaseAngleDeg) {
    const size_t triangleCount = mesh.triangleCount();
    const float creaseCosine = std::cos(glm::radians(creaseAngleDeg));
    std::vector<glm::vec3> areaNormals(triangleCount);
    std::vector<std::vector<uint32_t>> trianglesOf(mesh.positions.size());
    for (size_t t = 0; t < triangleCount; ++t) {
        const uint32_t* corner = &mesh.indices[3 * t];
        const glm::vec3& origin = mesh.positions[corner[0]];
        areaNormals[t] =
            glm::cross(mesh.positions[corner[1]] - origin, mesh.positions[corner[2]] - origin);
        for (int k = 0; k < 3; ++k) trianglesOf[corner[k]].push_back(static_cast<uint32_t>(t));
    }
    Mesh result;
    std::vector<std::vector<uint32_t>> copiesOf(mesh.positions.size());
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
        const uint32_t vertex = mesh.indices[i];
        const glm::vec3 faceNormal = glm::normalize(areaNormals[i / 3]);
        glm::vec3 sum(0);
        for (const uint32_t t : trianglesOf[vertex]) {
            if (glm::dot(glm::normalize(areaNormals[t]), faceNormal) >= creaseCosine)
                sum += areaNormals[t];
        }
        const glm::vec3 normal = glm::normalize(sum);
        auto& copies = copiesOf[vertex];
        uint32_t found = UINT32_MAX;
        for (const uint32_t copy : copies) {
            if (glm::dot(result.normals[copy], normal) > 0.9999F) found = copy;
        }
        if (found == UINT32_MAX) {
            found = static_cast<uint32_t>(result.positions.size());
            result.positions.push_back(mesh.positions[vertex]);
            result.normals.push_back(normal);
            copies.push_back(found);
        }
        result.indices.push_back(found);
    }
    return result;
}

}  // namespace tools
