// SPDX-License-Identifier: MIT
// Coverage and depth of the rasteriser against an exact integer twin.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/shared/gbuffer.h"
#include "tests/reference/gbuffer_run.h"
#include "tests/reference/raster_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

constexpr int kCellWidth = 61, kCellHeight = 37, kCellColumns = 12;

glm::vec3 worldOf(const glm::dvec2& pixel, double z = 0) {
    return {pixel.x, -pixel.y, z};
}

/// A node per triangle, double-sided, each drawn into a cell of its own.
GBufferRun drawInCells(const std::vector<PixelTriangle>& triangles) {
    SceneBuilder builder;
    builder.material().doubleSided = true;
    const int rows = (static_cast<int>(triangles.size()) + kCellColumns - 1) / kCellColumns;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const glm::dvec2 cell(kCellWidth * static_cast<double>(t % kCellColumns),
                              kCellHeight * static_cast<double>(t / kCellColumns));
        std::vector<glm::vec3> corners;
        for (const auto& v : triangles[t]) corners.push_back(worldOf(v + cell));
        builder.addMesh(corners, {0, 1, 2});
    }
    const int width = kCellColumns * kCellWidth, height = rows * kCellHeight;
    return runGBuffer(builder.scene(), pixelCamera(width, height), width, height);
}

bool drawn(const GBufferRun& run, std::size_t triangle, int x, int y) {
    const int column = static_cast<int>(triangle) % kCellColumns * kCellWidth + x;
    const int row = static_cast<int>(triangle) / kCellColumns * kCellHeight + y;
    return run.object(column, row) == triangle + 1;
}

/// Compares each triangle with the twin; returns how often each pixel of a cell was covered.
std::vector<int> checkCoverage(const std::vector<PixelTriangle>& triangles) {
    const auto run = drawInCells(triangles);
    std::vector<int> covered(kCellWidth * kCellHeight, 0);
    std::size_t wrong = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int y = 0; y < kCellHeight; ++y)
            for (int x = 0; x < kCellWidth; ++x) {
                const bool is = drawn(run, t, x, y);
                wrong += is != coversReference(triangles[t], x, y);
                covered[static_cast<std::size_t>(y * kCellWidth + x)] += is;
            }
    EXPECT_EQ(wrong, 0U);
    return covered;
}

/// Every pixel whose centre lies well inside of the rectangle is covered once, and none twice.
void expectWatertight(const std::vector<int>& covered, double low, double highX, double highY) {
    int gaps = 0, overlaps = 0;
    for (int y = 0; y < kCellHeight; ++y)
        for (int x = 0; x < kCellWidth; ++x) {
            const int count = covered[static_cast<std::size_t>(y * kCellWidth + x)];
            const bool inside =
                x + 0.5 > low && x + 0.5 < highX && y + 0.5 > low && y + 0.5 < highY;
            overlaps += count > 1;
            gaps += inside && count == 0;
        }
    EXPECT_EQ(gaps, 0);
    EXPECT_EQ(overlaps, 0);
}

/// A grid over [1, 60] x [1, 36] whose inner vertices are moved by up to `jitter` cells; all
/// vertices are multiples of `step`. Winding alternates at random.
std::vector<PixelTriangle> gridMesh(std::mt19937& random, int columns, int rows, double jitter,
                                    double step) {
    std::uniform_real_distribution<double> move(-jitter, jitter);
    const double dx = 59.0 / columns, dy = 35.0 / rows;
    std::vector<glm::dvec2> v;
    for (int r = 0; r <= rows; ++r)
        for (int c = 0; c <= columns; ++c) {
            const bool innerX = c > 0 && c<columns, innerY = r> 0 && r < rows;
            const glm::dvec2 p{1 + c * dx + (innerX ? move(random) * dx : 0),
                               1 + r * dy + (innerY ? move(random) * dy : 0)};
            v.push_back(glm::round(p / step) * step);
        }
    std::vector<PixelTriangle> triangles;
    const auto at = [&](int c, int r) {
        return v[static_cast<std::size_t>(r * (columns + 1) + c)];
    };
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            triangles.push_back({at(c, r), at(c + 1, r), at(c + 1, r + 1)});
            triangles.push_back({at(c, r), at(c, r + 1), at(c + 1, r + 1)});
            if (random() % 2) std::swap(triangles.back()[0], triangles.back()[2]);
        }
    return triangles;
}

TEST(Raster, JitteredGridsCoverEachPixelOnceAlongSharedEdges) {
    for (unsigned seed = 0; seed < 4; ++seed) {
        std::mt19937 random(seed);
        const int columns = 2 + static_cast<int>(seed) * 3;
        const auto covered = checkCoverage(gridMesh(random, columns, 3, 0.3, 1.0 / 4096));
        expectWatertight(covered, 1, 60, 36);
    }
}

TEST(Raster, VerticesAtPixelCentresAndCornersLeaveNoGapAndNoOverlap) {
    std::mt19937 random(7);
    expectWatertight(checkCoverage(gridMesh(random, 9, 5, 0.3, 0.5)), 1, 60, 36);
    expectWatertight(checkCoverage(gridMesh(random, 9, 5, 0.3, 1)), 1, 60, 36);
    expectWatertight(checkCoverage(gridMesh(random, 4, 2, 0.3, 0.25)), 1, 60, 36);
}

TEST(Raster, FansAroundACommonVertexCoverEachPixelOnce) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const glm::dvec2 hub : {glm::dvec2(30.5, 18.5), glm::dvec2(17.3125, 9.4375)}) {
        std::vector<glm::dvec2> rim;
        for (int i = 0; i < 12; ++i) rim.emplace_back(1 + 59 * (i + unit(random)) / 12.2, 1);
        for (int i = 0; i < 8; ++i) rim.emplace_back(60, 1 + 35 * (i + unit(random)) / 8.2);
        for (int i = 0; i < 12; ++i) rim.emplace_back(60 - 59 * (i + unit(random)) / 12.2, 36);
        for (int i = 0; i < 8; ++i) rim.emplace_back(1, 36 - 35 * (i + unit(random)) / 8.2);
        for (auto& v : rim) v = glm::round(v * 4096.0) / 4096.0;
        std::vector<PixelTriangle> fan;
        for (std::size_t i = 0; i < rim.size(); ++i)
            fan.push_back({hub, rim[i], rim[(i + 1) % rim.size()]});
        expectWatertight(checkCoverage(fan), 6, 55, 31);
    }
}

TEST(Raster, NeedlesAndRandomTrianglesCoverWhatTheTwinCovers) {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> x(0, 61), y(0, 37), thin(-0.05, 0.05);
    std::vector<PixelTriangle> triangles;
    for (int i = 0; i < 120; ++i) {
        const glm::dvec2 a{x(random), y(random)}, b{x(random), y(random)};
        const glm::dvec2 c = i % 2 ? a + (b - a) * 0.3 + glm::dvec2{thin(random), thin(random)}
                                   : glm::dvec2{x(random), y(random)};
        PixelTriangle t{a, b, c};
        for (auto& v : t) v = glm::round(v * 4096.0) / 4096.0;
        triangles.push_back(t);
    }
    checkCoverage(triangles);
}

TEST(Raster, NearestTriangleWinsAndTiesGoToTheLowestIndex) {
    std::mt19937 random(17);
    std::uniform_real_distribution<double> x(0, 61), y(0, 37);
    std::vector<PixelTriangle> triangles;
    std::vector<int> depths;
    SceneBuilder builder;
    builder.material().doubleSided = true;
    for (int i = 0; i < 80; ++i) {
        PixelTriangle t;
        for (auto& v : t) v = glm::round(glm::dvec2{x(random), y(random)} * 64.0) / 64.0;
        triangles.push_back(t);
        depths.push_back(static_cast<int>(random() % 5));
        builder.addMesh({worldOf(t[0], depths.back()), worldOf(t[1], depths.back()),
                         worldOf(t[2], depths.back())},
                        {0, 1, 2});
    }
    for (const bool wide : {true, false}) {
        const auto run = runGBuffer(builder.scene(), pixelCamera(kCellWidth, kCellHeight),
                                    kCellWidth, kCellHeight, glm::dvec3(0), wide);
        int wrong = 0;
        for (int row = 0; row < kCellHeight; ++row)
            for (int column = 0; column < kCellWidth; ++column) {
                std::uint32_t winner = 0;
                int nearest = -1;
                for (std::size_t t = 0; t < triangles.size(); ++t)
                    if (depths[t] > nearest && coversReference(triangles[t], column, row))
                        nearest = depths[t], winner = static_cast<std::uint32_t>(t) + 1;
                wrong += run.object(column, row) != winner;
            }
        EXPECT_EQ(wrong, 0) << "64-bit atomics " << wide;
    }
}

TEST(Raster, FloorBehindTheCameraCoversAllPixelsBelowTheHorizon) {
    SceneBuilder builder;
    builder.addQuad({-1000, 0, 1000}, {2000, 0, 0}, {0, 0, -2000});
    const auto camera = perspectiveCamera({0.3, 1, 0.2}, {0.7, 1, -5}, 60);
    const auto run = runGBuffer(builder.scene(), camera, kCellWidth, kCellHeight);
    for (int y = 0; y < kCellHeight; ++y)
        for (int x = 0; x < kCellWidth; ++x) {
            const glm::dvec3 ray = pixelRay(camera, kCellWidth, kCellHeight, x, y);
            ASSERT_EQ(run.object(x, y), ray.y < -2e-3 ? 1U : 0U) << x << ' ' << y;
            if (ray.y >= -2e-3) continue;
            EXPECT_NEAR(run.value(GB_DEPTH, x, y) * -ray.y, 1, 2e-4);
            EXPECT_NEAR(run.value(GB_POSITION + 1, x, y), 0, 1e-4);
        }
}

TEST(Raster, AHugeTriangleCoversWhatRaysHit) {
    SceneBuilder builder;
    const glm::dvec3 corner[3] = {{-1e6, 0, 1e6}, {1e6, 0, 1e6}, {3e5, 0, -1e6}};
    builder.addMesh({corner[0], corner[1], corner[2]}, {0, 1, 2});
    const auto camera = perspectiveCamera({0, 3e5, 9e5}, {0, 0, -2e5}, 70);
    const auto run = runGBuffer(builder.scene(), camera, kCellWidth, kCellHeight);
    const glm::dvec3 eye(camera.worldFromCamera[3]);
    int covered = 0;
    for (int y = 0; y < kCellHeight; ++y)
        for (int x = 0; x < kCellWidth; ++x) {
            const glm::dvec3 ray = pixelRay(camera, kCellWidth, kCellHeight, x, y);
            const double t = -eye.y / ray.y;
            const glm::dvec3 hit = eye + t * ray;
            double margin = 1e9;
            for (int i = 0; i < 3; ++i) {
                const auto edge = glm::normalize(corner[(i + 1) % 3] - corner[i]);
                margin = std::min(margin, glm::cross(edge, hit - corner[i]).y);
            }
            if (std::abs(margin) < 0.01 * std::abs(t)) continue;  // a pixel is about 0.04 t wide
            ASSERT_EQ(run.object(x, y) != 0, t > 0 && margin > 0) << x << ' ' << y;
            if (run.object(x, y) == 0) continue;
            ++covered;
            EXPECT_NEAR(run.value(GB_DEPTH, x, y) / t, 1, 1e-4);
        }
    EXPECT_GT(covered, 500);
}

/// Nearest triangle along a ray beyond depth `nearest`, by Cramer's rule; -1: none.
int nearestAlong(const std::vector<std::array<glm::dvec3, 3>>& triangles, const glm::dvec3& eye,
                 const glm::dvec3& ray, double nearest) {
    int found = -1;
    double best = 1e300;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto& [a, b, c] = triangles[i];
        const glm::dmat3 m(a - eye, b - eye, c - eye);
        const glm::dvec3 weights = glm::inverse(m) * ray;
        if (weights.x < 0 || weights.y < 0 || weights.z < 0) continue;
        const double t = 1 / (weights.x + weights.y + weights.z);
        if (t > nearest && t < best) best = t, found = static_cast<int>(i);
    }
    return found;
}

TEST(Raster, TrianglesAllAroundTheCameraAreSeenWhereRaysHitThem) {
    for (const double extent : {3.0, 1e2, 1e5}) {
        std::mt19937 random(23);
        std::uniform_real_distribution<float> at(-static_cast<float>(extent),
                                                 static_cast<float>(extent));
        std::vector<std::array<glm::dvec3, 3>> triangles;
        SceneBuilder builder;
        builder.material().doubleSided = true;
        for (int i = 0; i < 60; ++i) {
            std::vector<glm::vec3> v;
            for (int c = 0; c < 3; ++c) v.push_back({at(random), at(random), at(random)});
            triangles.push_back({v[0], v[1], v[2]});
            builder.addMesh(v, {0, 1, 2});
        }
        auto camera = perspectiveCamera({0, 0, 0}, {1, 0.3, -2}, 80);
        camera.nearMetres = 0.1;
        const auto run = runGBuffer(builder.scene(), camera, kCellWidth, kCellHeight);
        int wrong = 0, covered = 0;
        for (int y = 0; y < kCellHeight; ++y)
            for (int x = 0; x < kCellWidth; ++x) {
                const auto ray = pixelRay(camera, kCellWidth, kCellHeight, x, y);
                const int truth = nearestAlong(triangles, glm::dvec3(0), ray, camera.nearMetres);
                wrong += run.object(x, y) != static_cast<std::uint32_t>(truth + 1);
                covered += truth >= 0;
            }
        EXPECT_GT(covered, 1000) << extent;
        EXPECT_LE(wrong, 8) << extent;  // snapping to 1/256 pixel
    }
}

TEST(Raster, OrthographicCamerasOrderSurfacesFarBeyondZfar) {
    SceneBuilder builder;
    builder.material().doubleSided = true;
    for (const float z : {-500.0F, -60.0F, -300.0F})
        builder.addQuad({0, -37, z}, {61, 0, 0}, {0, 37, 0});
    auto scene = builder.scene();
    const auto placed = pixelCamera(kCellWidth, kCellHeight);
    scene::Camera camera;
    camera.orthographic = true;
    camera.node = builder.addMesh({}, {}, placed.worldFromCamera);
    camera.xmag = placed.xmag, camera.ymag = placed.ymag;
    camera.znear = 1, camera.zfar = 5;
    scene = builder.scene();
    scene.cameras.push_back(camera);
    const auto pose = scene::poseAt(scene, {}, 0);
    const auto frame = scene::cameraAt(scene, pose, {}, scene::clipBounds(scene, {}), 61.0 / 37);
    for (const bool wide : {true, false}) {
        const auto run = runGBuffer(scene, frame, kCellWidth, kCellHeight, glm::dvec3(0), wide);
        EXPECT_EQ(run.object(30, 18), 2U) << "64-bit atomics " << wide;
        EXPECT_NEAR(run.value(GB_DEPTH, 30, 18), 70, 1e-3);
    }
}

}  // namespace
}  // namespace penumbra::tests
