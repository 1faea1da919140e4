// SPDX-License-Identifier: MIT
#include "make_scene_simplify.h"

#include <algorithm>
#include <array>
#include <map>
#include <queue>
#include <stdexcept>
#include <string>
#include <tuple>

namespace tools {

namespace {

using glm::dvec3;

constexpr double kBorderWeight = 4;        // of the planes that hold lines between labels
constexpr double kKeptShapeWeight = 1e-3;  // of the edge's own length: even meshes on flat parts
// Cosines: a collapse may turn a triangle no further. The second is for meshes that the first
// stops.
constexpr double kLeastTurns[] = {0.2, -0.7};

// Sum of squared distances to planes, v^T A v + 2 b v + c.
struct Quadric {
    glm::dmat3 a{0};
    dvec3 b{0};
    double c = 0;

    void addPlane(const dvec3& normal, const dvec3& point, double weight) {
        const double offset = -glm::dot(normal, point);
        a += weight * glm::outerProduct(normal, normal);
        b += weight * offset * normal;
        c += weight * offset * offset;
    }
    void add(const Quadric& other) {
        a += other.a;
        b += other.b;
        c += other.c;
    }
    double errorAt(const dvec3& v) const { return glm::dot(v, a * v) + 2 * glm::dot(b, v) + c; }
};

using Candidate = std::tuple<double, uint32_t, uint32_t, uint32_t, uint32_t>;  // error, ends, ages

class Simplifier {
  public:
    Simplifier(Mesh& mesh, std::vector<uint8_t>& labels);
    void run(size_t triangleCount);

  private:
    dvec3 at(uint32_t vertex) const { return mesh_.positions[vertex]; }
    const uint32_t* cornersOf(uint32_t triangle) const { return &mesh_.indices[3 * triangle]; }
    bool has(uint32_t triangle, uint32_t vertex) const {
        const uint32_t* c = cornersOf(triangle);
        return c[0] == vertex || c[1] == vertex || c[2] == vertex;
    }
    void addQuadrics();
    void proposeAll();
    dvec3 placeFor(uint32_t a, uint32_t b, double& error) const;
    void propose(uint32_t a, uint32_t b);
    std::vector<uint32_t> neighboursOf(uint32_t vertex) const;
    bool isLinkSimple(uint32_t a, uint32_t b) const;
    bool folds(uint32_t vertex, uint32_t other, const dvec3& place) const;
    bool collapse(uint32_t a, uint32_t b);
    void compact();

    Mesh& mesh_;
    std::vector<uint8_t>& labels_;
    std::vector<std::vector<uint32_t>> trianglesOf_;
    std::vector<Quadric> quadrics_;
    std::vector<uint32_t> ages_;  // a candidate of another age is out of date
    std::vector<bool> isGone_;    // [triangles]
    double leastTurn_ = kLeastTurns[0];
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
};

Simplifier::Simplifier(Mesh& mesh, std::vector<uint8_t>& labels) : mesh_(mesh), labels_(labels) {
    const size_t vertexCount = mesh.positions.size();
    trianglesOf_.resize(vertexCount);
    quadrics_.resize(vertexCount);
    ages_.resize(vertexCount);
    isGone_.resize(mesh.triangleCount());
    for (size_t i = 0; i < mesh.indices.size(); ++i)
        trianglesOf_[mesh.indices[i]].push_back(static_cast<uint32_t>(i / 3));
    addQuadrics();
    proposeAll();
}

void Simplifier::proposeAll() {
    for (uint32_t vertex = 0; vertex < trianglesOf_.size(); ++vertex)
        for (const uint32_t other : neighboursOf(vertex))
            if (vertex < other) propose(vertex, other);
}

void Simplifier::addQuadrics() {
    for (uint32_t t = 0; t < mesh_.triangleCount(); ++t) {
        const uint32_t* corner = cornersOf(t);
        const dvec3 cross =
            glm::cross(at(corner[1]) - at(corner[0]), at(corner[2]) - at(corner[0]));
        const double doubleArea = glm::length(cross);
        if (doubleArea <= 0) continue;
        const dvec3 normal = cross / doubleArea;
        for (int k = 0; k < 3; ++k) {
            quadrics_[corner[k]].addPlane(normal, at(corner[k]), doubleArea);
            if (labels_.empty()) continue;
            // Across an edge to another label, a plane through the edge
            const uint32_t from = corner[k], to = corner[(k + 1) % 3];
            for (const uint32_t other : trianglesOf_[from]) {
                if (!has(other, to) || labels_[other] == labels_[t]) continue;
                const dvec3 edge = at(to) - at(from);
                const dvec3 across = glm::cross(edge, normal);
                const double length = glm::length(across);
                if (length <= 0) continue;
                for (const uint32_t end : {from, to})
                    quadrics_[end].addPlane(across / length, at(from),
                                            kBorderWeight * glm::dot(edge, edge));
            }
        }
    }
}

// The place of least error on the edge's line or, where the quadric has one, in space.
dvec3 Simplifier::placeFor(uint32_t a, uint32_t b, double& error) const {
    Quadric sum = quadrics_[a];
    sum.add(quadrics_[b]);
    const dvec3 middle = 0.5 * (at(a) + at(b));
    dvec3 best = middle;
    error = sum.errorAt(middle);
    const auto tryPlace = [&](const dvec3& place) {
        const double found = sum.errorAt(place);
        if (found < error) error = found, best = place;
    };
    tryPlace(at(a));
    tryPlace(at(b));
    const double trace = sum.a[0][0] + sum.a[1][1] + sum.a[2][2];
    if (glm::determinant(sum.a) > 1e-4 * trace * trace * trace) {
        const dvec3 free = glm::inverse(sum.a) * -sum.b;
        if (glm::distance(free, middle) < glm::distance(at(a), at(b))) tryPlace(free);
    }
    return best;
}

void Simplifier::propose(uint32_t a, uint32_t b) {
    if (a > b) std::swap(a, b);
    double error = 0;
    placeFor(a, b, error);
    const dvec3 edge = at(b) - at(a);
    const double squared = glm::dot(edge, edge);
    queue_.emplace(std::max(error, 0.0) + kKeptShapeWeight * squared * squared, a, b, ages_[a],
                   ages_[b]);
}

std::vector<uint32_t> Simplifier::neighboursOf(uint32_t vertex) const {
    std::vector<uint32_t> found;
    for (const uint32_t t : trianglesOf_[vertex])
        for (int k = 0; k < 3; ++k)
            if (cornersOf(t)[k] != vertex) found.push_back(cornersOf(t)[k]);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

// The two ends share exactly the two vertices opposite to the edge; else the mesh would pinch.
bool Simplifier::isLinkSimple(uint32_t a, uint32_t b) const {
    const auto ofA = neighboursOf(a), ofB = neighboursOf(b);
    std::vector<uint32_t> both;
    std::set_intersection(ofA.begin(), ofA.end(), ofB.begin(), ofB.end(), std::back_inserter(both));
    return both.size() == 2 && ofA.size() + ofB.size() > 7;
}

bool Simplifier::folds(uint32_t vertex, uint32_t other, const dvec3& place) const {
    for (const uint32_t t : trianglesOf_[vertex]) {
        if (has(t, other)) continue;
        std::array<dvec3, 3> before, after;
        for (int k = 0; k < 3; ++k) {
            before[k] = at(cornersOf(t)[k]);
            after[k] = cornersOf(t)[k] == vertex ? place : before[k];
        }
        const dvec3 was = glm::cross(before[1] - before[0], before[2] - before[0]);
        const dvec3 is = glm::cross(after[1] - after[0], after[2] - after[0]);
        if (glm::dot(was, is) <= leastTurn_ * glm::length(was) * glm::length(is)) return true;
    }
    return false;
}

bool Simplifier::collapse(uint32_t a, uint32_t b) {
    if (!isLinkSimple(a, b)) return false;
    double error = 0;
    const dvec3 place = placeFor(a, b, error);
    if (folds(a, b, place) || folds(b, a, place)) return false;
    for (const uint32_t t : trianglesOf_[b]) {
        if (has(t, a)) {
            isGone_[t] = true;
            continue;
        }
        std::replace(&mesh_.indices[3 * t], &mesh_.indices[3 * t] + 3, b, a);
        trianglesOf_[a].push_back(t);
    }
    trianglesOf_[b].clear();
    mesh_.positions[a] = place;
    quadrics_[a].add(quadrics_[b]);
    ++ages_[b];
    ++ages_[a];
    const auto drop = [&](uint32_t vertex) {
        auto& list = trianglesOf_[vertex];
        list.erase(std::remove_if(list.begin(), list.end(), [&](uint32_t t) { return isGone_[t]; }),
                   list.end());
    };
    drop(a);
    const auto around = neighboursOf(a);
    for (const uint32_t other : around) drop(other);
    for (const uint32_t other : around) propose(a, other);
    return true;
}

void Simplifier::run(size_t triangleCount) {
    size_t left = mesh_.triangleCount();
    while (left > triangleCount) {
        if (queue_.empty() && leastTurn_ == kLeastTurns[0]) {
            leastTurn_ = kLeastTurns[1];
            proposeAll();
        }
        if (queue_.empty())
            throw std::runtime_error("a mesh of " + std::to_string(left) +
                                     " triangles cannot be brought to " +
                                     std::to_string(triangleCount));
        const auto [error, a, b, ageA, ageB] = queue_.top();
        queue_.pop();
        if (ages_[a] != ageA || ages_[b] != ageB) continue;
        if (collapse(a, b)) left -= 2;
    }
    compact();
}

void Simplifier::compact() {
    Mesh result;
    std::vector<uint8_t> labels;
    std::vector<uint32_t> numberOf(mesh_.positions.size(), UINT32_MAX);
    for (uint32_t t = 0; t < mesh_.triangleCount(); ++t) {
        if (isGone_[t]) continue;
        if (!labels_.empty()) labels.push_back(labels_[t]);
        for (int k = 0; k < 3; ++k) {
            uint32_t& number = numberOf[cornersOf(t)[k]];
            if (number == UINT32_MAX) {
                number = static_cast<uint32_t>(result.positions.size());
                result.positions.push_back(mesh_.positions[cornersOf(t)[k]]);
            }
            result.indices.push_back(number);
        }
    }
    mesh_ = std::move(result);
    labels_ = std::move(labels);
}

}  // namespace

void simplify(Mesh& mesh, std::vector<uint8_t>& labels, size_t triangleCount) {
    mesh.normals.clear();
    Simplifier(mesh, labels).run(triangleCount);
}

}  // namespace tools
