// SPDX-License-Identifier: MIT
// Surface nets on a grid of varying spacing, projection onto the surface, and cuts along material
// borders.
#include "make_scene_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace tools {

namespace {

constexpr float kGradientStep = 0.0015F;  // metres

// Samples of the field and the net's vertex numbers, both [x, y, z] with z fastest.
struct Net {
    const SampleGrid& grid;
    std::array<size_t, 3> size;
    std::vector<float> values;
    std::vector<uint32_t> vertexOf;

    size_t indexOf(size_t i, size_t j, size_t k) const { return (i * size[1] + j) * size[2] + k; }
    glm::vec3 positionOf(size_t i, size_t j, size_t k) const {
        return glm::vec3(grid.x[i], grid.y[j], grid.z[k]);
    }
};

glm::vec3 projectOnto(const Field& surface, glm::vec3 position, float largestStep) {
    for (int iteration = 0; iteration < 4; ++iteration) {
        const glm::vec3 gradient = computeGradient(surface, position, kGradientStep);
        const glm::vec3 step =
            gradient * (surface(position) / std::max(glm::dot(gradient, gradient), 1e-3F));
        const float length = glm::length(step);
        position -= length > largestStep ? step * (largestStep / length) : step;
    }
    return position;
}

// Samples the field. Blocks that the surface cannot reach get the sign of their middle: fields here
// grow by less than kSteepest per metre.
void sampleField(Net& net, const Field& surface) {
    constexpr size_t kBlock = 6;
    constexpr float kSteepest = 2;
    net.values.resize(net.size[0] * net.size[1] * net.size[2]);
    const auto end = [&](size_t from, size_t axis) {
        return std::min(from + kBlock, net.size[axis]);
    };
    for (size_t i = 0; i < net.size[0]; i += kBlock) {
        for (size_t j = 0; j < net.size[1]; j += kBlock) {
            for (size_t k = 0; k < net.size[2]; k += kBlock) {
                const size_t endI = end(i, 0), endJ = end(j, 1), endK = end(k, 2);
                const glm::vec3 low = net.positionOf(i, j, k);
                const glm::vec3 high = net.positionOf(endI - 1, endJ - 1, endK - 1);
                const float middle = surface(0.5F * (low + high));
                const bool isFar = std::abs(middle) > 0.5F * kSteepest * glm::distance(low, high);
                for (size_t a = i; a < endI; ++a)
                    for (size_t b = j; b < endJ; ++b)
                        for (size_t c = k; c < endK; ++c)
                            net.values[net.indexOf(a, b, c)] =
                                isFar ? middle : surface(net.positionOf(a, b, c));
            }
        }
    }
}

// A grid face whose corners alternate in sign would give an edge shared by four quads: the value
// nearest to zero changes sides. Returns whether it found any.
bool removeSaddles(Net& net) {
    const std::array<size_t, 3> strides = {net.size[1] * net.size[2], net.size[2], 1};
    bool found = false;
    for (size_t here = 0; here < net.values.size(); ++here) {
        for (size_t axis = 0; axis < 3; ++axis) {
            const size_t u = strides[axis];
            const size_t v = strides[(axis + 1) % 3];
            if (here + u + v >= net.values.size()) continue;
            const std::array<size_t, 4> corners = {here, here + u, here + u + v, here + v};
            bool alternates = true;
            for (size_t k = 0; k < 4; ++k) {
                alternates &=
                    (net.values[corners[k]] < 0) != (net.values[corners[(k + 1) % 4]] < 0);
            }
            if (!alternates) continue;
            const size_t least =
                *std::min_element(corners.begin(), corners.end(), [&](size_t a, size_t b) {
                    return std::abs(net.values[a]) < std::abs(net.values[b]);
                });
            net.values[least] = net.values[least] < 0 ? 1e-6F : -1e-6F;
            found = true;
        }
    }
    return found;
}

// The mean of the points where the surface crosses the cell's edges, or nothing to add.
bool findCellVertex(const Net& net, size_t i, size_t j, size_t k, glm::vec3& mean) {
    int crossingCount = 0;
    mean = glm::vec3(0);
    for (unsigned a = 0; a < 8; ++a) {
        for (unsigned bit = 1; bit < 8; bit <<= 1U) {
            const unsigned b = a | bit;
            if (b == a) continue;
            const auto at = [&](unsigned c) {
                return std::array<size_t, 3>{i + (c & 1U), j + ((c >> 1U) & 1U), k + (c >> 2U)};
            };
            const auto from = at(a);
            const auto to = at(b);
            const float valueFrom = net.values[net.indexOf(from[0], from[1], from[2])];
            const float valueTo = net.values[net.indexOf(to[0], to[1], to[2])];
            if ((valueFrom < 0) == (valueTo < 0)) continue;
            mean +=
                glm::mix(net.positionOf(from[0], from[1], from[2]),
                         net.positionOf(to[0], to[1], to[2]), valueFrom / (valueFrom - valueTo));
            ++crossingCount;
        }
    }
    if (crossingCount > 0) mean /= static_cast<float>(crossingCount);
    return crossingCount > 0;
}

void addVertices(Net& net, const Field& surface, Mesh& mesh) {
    net.vertexOf.assign(net.values.size(), UINT32_MAX);
    for (size_t i = 0; i + 1 < net.size[0]; ++i) {
        for (size_t j = 0; j + 1 < net.size[1]; ++j) {
            for (size_t k = 0; k + 1 < net.size[2]; ++k) {
                glm::vec3 mean;
                if (!findCellVertex(net, i, j, k, mean)) continue;
                const glm::vec3 cell =
                    net.positionOf(i + 1, j + 1, k + 1) - net.positionOf(i, j, k);
                net.vertexOf[net.indexOf(i, j, k)] = static_cast<uint32_t>(mesh.positions.size());
                mesh.positions.push_back(
                    projectOnto(surface, mean, 0.25F * std::min({cell.x, cell.y, cell.z})));
            }
        }
    }
}

// Splits the quad along its shorter diagonal.
void addQuad(Mesh& mesh, std::array<uint32_t, 4> q, bool reversed) {
    if (reversed) std::swap(q[1], q[3]);
    const auto& p = mesh.positions;
    if (glm::distance(p[q[0]], p[q[2]]) <= glm::distance(p[q[1]], p[q[3]])) {
        mesh.indices.insert(mesh.indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
    } else {
        mesh.indices.insert(mesh.indices.end(), {q[1], q[2], q[3], q[1], q[3], q[0]});
    }
}

// One quad around each grid edge along `axis` whose ends differ in sign.
void addQuads(const Net& net, size_t axis, Mesh& mesh) {
    const std::array<size_t, 3> strides = {net.size[1] * net.size[2], net.size[2], 1};
    const size_t u = strides[(axis + 1) % 3];
    const size_t v = strides[(axis + 2) % 3];
    for (size_t i = 1; i + 1 < net.size[0]; ++i) {
        for (size_t j = 1; j + 1 < net.size[1]; ++j) {
            for (size_t k = 1; k + 1 < net.size[2]; ++k) {
                const size_t here = net.indexOf(i, j, k);
                const bool isInside = net.values[here] < 0;
                if (isInside == (net.values[here + strides[axis]] < 0)) continue;
                addQuad(mesh,
                        {net.vertexOf[here - u - v], net.vertexOf[here - v], net.vertexOf[here],
                         net.vertexOf[here - u]},
                        !isInside);
            }
        }
    }
}

}  // namespace

glm::vec3 computeGradient(const Field& field, const glm::vec3& position, float step) {
    glm::vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 offset(0);
        offset[axis] = step;
        gradient[axis] = (field(position + offset) - field(position - offset)) / (2 * step);
    }
    return gradient;
}

std::vector<glm::vec3> normalsOf(const Field& surface, const std::vector<glm::vec3>& positions) {
    std::vector<glm::vec3> normals;
    for (const glm::vec3& position : positions)
        normals.push_back(glm::normalize(computeGradient(surface, position, kGradientStep)));
    return normals;
}

Mesh polygonise(const Field& surface, const SampleGrid& grid) {
    Net net{grid, {grid.x.size(), grid.y.size(), grid.z.size()}, {}, {}};
    sampleField(net, surface);
    for (int pass = 0; pass < 20 && removeSaddles(net); ++pass) {
    }
    Mesh mesh;
    addVertices(net, surface, mesh);
    for (size_t axis = 0; axis < 3; ++axis) addQuads(net, axis, mesh);
    mesh.normals = normalsOf(surface, mesh.positions);
    return mesh;
}

void cutAlong(Mesh& mesh, const Field& border, const Field& surface, float snapDistance) {
    const auto settle = [&](size_t vertex) {
        mesh.positions[vertex] = projectOnto(surface, mesh.positions[vertex], 0.002F);
        mesh.normals[vertex] =
            glm::normalize(computeGradient(surface, mesh.positions[vertex], kGradientStep));
    };
    std::vector<float> side(mesh.positions.size());
    for (size_t vertex = 0; vertex < side.size(); ++vertex) {
        side[vertex] = border(mesh.positions[vertex]);
        if (std::abs(side[vertex]) >= snapDistance) continue;
        // Slide along the surface: the part of the border's gradient that is tangent to it.
        const glm::vec3 gradient = computeGradient(border, mesh.positions[vertex], kGradientStep);
        const glm::vec3 tangent =
            gradient - mesh.normals[vertex] * glm::dot(gradient, mesh.normals[vertex]);
        if (glm::dot(tangent, tangent) < 0.25F) continue;
        mesh.positions[vertex] -= tangent * (side[vertex] / glm::dot(tangent, tangent));
        settle(vertex);
        side[vertex] = 0;
    }
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middleOf;
    const auto cutEdge = [&](uint32_t a, uint32_t b) {
        const auto [entry, isNew] =
            middleOf.try_emplace(std::minmax(a, b), static_cast<uint32_t>(mesh.positions.size()));
        if (isNew) {
            const float share = side[a] / (side[a] - side[b]);
            mesh.positions.push_back(glm::mix(mesh.positions[a], mesh.positions[b], share));
            mesh.normals.emplace_back(0);
            settle(entry->second);
        }
        return entry->second;
    };
    std::vector<uint32_t> indices;
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
        std::array<uint32_t, 6> loop{};  // the triangle's outline with the cuts in it
        std::vector<size_t> cuts;
        size_t count = 0;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = mesh.indices[t + k];
            const uint32_t b = mesh.indices[t + (k + 1) % 3];
            if (side[a] == 0) cuts.push_back(count);
            loop[count++] = a;
            if (side[a] * side[b] < 0) {
                cuts.push_back(count);
                loop[count++] = cutEdge(a, b);
            }
        }
        // Fan from a point on the border, so that the line between two cuts is always an edge.
        const size_t first = cuts.empty() ? 0 : cuts[0];
        for (size_t k = 1; k + 1 < count; ++k) {
            indices.insert(indices.end(),
                           {loop[first], loop[(first + k) % count], loop[(first + k + 1) % count]});
        }
    }
    mesh.indices = std::move(indices);
}

}  // namespace tools
